#include "estimators/core/value_checks.h"

#include <cmath>

namespace assay {

double finite_number(const Value& value, const std::string& what) {
  const double number = value.number(what);
  if (!std::isfinite(number)) throw InputError(value.where(), what + " must be finite");
  return number;
}

double at_least_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  if (number < 0) throw InputError(value.where(), what + " must not be negative");
  return number;
}

double above_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  if (!(number > 0)) throw InputError(value.where(), what + " must be above 0");
  return number;
}

}  // namespace assay
