#include "stats/means/equivalence.h"

#include <algorithm>

#include "stats/basics/check.h"

namespace assay::stats {
namespace {

void check_margins(const char* function, Margins margins) {
  check::finite({function, "low margin"}, margins.low);
  check::finite({function, "high margin"}, margins.high);
  if (!(margins.low < margins.high)) {
    check::fail({function, "high margin"}, margins.high, "above the low margin");
  }
}

}  // namespace

Equivalence equivalence(const TestResult& at_low, const TestResult& at_high) {
  return {at_low, at_high, std::max(at_low.log_p_upper, at_high.log_p_lower)};
}

Equivalence student_t_equivalence(const Moments& x, Reference reference, Margins margins) {
  check_margins("student_t_equivalence", margins);
  const auto at = [&](double margin) {
    return student_t(x, {reference.value + margin, reference.standard_error});
  };
  return equivalence(at(margins.low), at(margins.high));
}

Equivalence welch_equivalence(const Moments& x, const Moments& y, Margins margins) {
  check_margins("welch_equivalence", margins);
  return equivalence(welch_t(x, y, {1, margins.low}), welch_t(x, y, {1, margins.high}));
}

Equivalence welch_relative_equivalence(const Moments& x, const Moments& y, Margins margins) {
  check_margins("welch_relative_equivalence", margins);
  const TestResult low = welch_t(x, y, {1 + margins.low, 0});
  const TestResult high = welch_t(x, y, {1 + margins.high, 0});
  return y.mean >= 0 ? equivalence(low, high) : equivalence(high, low);
}

}  // namespace assay::stats
