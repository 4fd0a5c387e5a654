#pragma once

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace assay::stats::check {

// Internal: argument checks. They throw std::domain_error "function: argument = value, must be …".

struct Argument {
  std::string_view function;
  std::string_view name;
};

template <class Value>
[[noreturn]] void fail(Argument argument, Value value, std::string_view requirement) {
  std::ostringstream message;
  message.precision(17);
  message << argument.function << ": " << argument.name << " = " << value << ", must be "
          << requirement;
  throw std::domain_error(message.str());
}

void finite(Argument argument, double value);
void positive(Argument argument, double value);         // Finite and > 0.
void non_negative(Argument argument, double value);     // Finite and >= 0.
void inside_unit(Argument argument, double value);      // In (0, 1).
void unit(Argument argument, double value);             // In [0, 1].
void log_probability(Argument argument, double value);  // At most 0, not NaN.
void at_least(Argument argument, std::uint64_t value, std::uint64_t minimum);

}  // namespace assay::stats::check
