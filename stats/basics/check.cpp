#include "stats/basics/check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace assay::stats::check {

void refuse(Argument argument, std::string_view value, std::string_view requirement) {
  std::string message(argument.function);
  message.append(": ").append(argument.name).append(value);
  throw std::domain_error(message.append(", must be ").append(requirement));
}

void fail(Argument argument, double value, std::string_view requirement) {
  if (std::isnan(value)) refuse(argument, " is not a number", requirement);
  if (std::isinf(value)) refuse(argument, " is infinite", requirement);
  std::array<char, 32> text{};
  std::to_chars(text.data(), text.data() + text.size(), value);
  refuse(argument, std::string(" = ") + text.data(), requirement);
}

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

void sorted(const char* function, std::span<const double> values) {
  at_least({function, "values"}, values.size(), 1);
  finite({function, "smallest value"}, values.front());
  finite({function, "largest value"}, values.back());
  // NaN fails every comparison, so an ordered range with finite ends is finite throughout.
  if (std::ranges::adjacent_find(values, std::not_fn(std::less_equal())) != values.end()) {
    throw std::domain_error(std::string(function) +
                            ": values must be sorted ascending, without NaN");
  }
}

}  // namespace assay::stats::check
