#include "stats/basics/check.h"

#include <cmath>
#include <string>

namespace assay::stats::check {

void finite(Argument argument, double value) {
  if (!std::isfinite(value)) fail(argument, value, "finite");
}

void positive(Argument argument, double value) {
  if (!std::isfinite(value) || !(value > 0)) fail(argument, value, "positive and finite");
}

void non_negative(Argument argument, double value) {
  if (!std::isfinite(value) || !(value >= 0)) fail(argument, value, "non-negative and finite");
}

void inside_unit(Argument argument, double value) {
  if (!(value > 0 && value < 1)) fail(argument, value, "inside (0, 1)");
}

void unit(Argument argument, double value) {
  if (!(value >= 0 && value <= 1)) fail(argument, value, "in [0, 1]");
}

void log_probability(Argument argument, double value) {
  if (!(value <= 0)) fail(argument, value, "a log probability, at most 0");
}

void at_least(Argument argument, std::uint64_t value, std::uint64_t minimum) {
  if (value < minimum) fail(argument, value, "at least " + std::to_string(minimum));
}

}  // namespace assay::stats::check
