#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace assay::stats::check {

// Internal: argument checks. They throw std::domain_error "function: argument = value, must be …".
// The value has the fewest digits that read back as it. The text is "argument is not a number" or
// "argument is infinite" where it is not finite.

struct Argument {
  std::string_view function;
  std::string_view name;
};

[[noreturn]] void refuse(Argument argument, std::string_view value, std::string_view requirement);
[[noreturn]] void fail(Argument argument, double value, std::string_view requirement);
template <std::unsigned_integral Count>
[[noreturn]] void fail(Argument argument, Count count, std::string_view requirement) {
  refuse(argument, " = " + std::to_string(count), requirement);
}

void finite(Argument argument, double value);
void positive(Argument argument, double value);         // Finite and > 0.
void non_negative(Argument argument, double value);     // Finite and >= 0.
void inside_unit(Argument argument, double value);      // In (0, 1).
void unit(Argument argument, double value);             // In [0, 1].
void log_probability(Argument argument, double value);  // At most 0, not NaN.
void at_least(Argument argument, std::uint64_t value, std::uint64_t minimum);
// One value or more, finite and ascending.
void sorted(const char* function, std::span<const double> values);

}  // namespace assay::stats::check
