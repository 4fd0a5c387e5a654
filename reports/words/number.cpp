#include "reports/words/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace assay::reports {
namespace {

constexpr const char* no_break_space = "\u00A0";

std::string non_finite(double value) {
  if (std::isnan(value)) return "NaN";
  return value > 0 ? "Infinity" : "-Infinity";
}

// Factors from 1 / 1.1 to 1.1 are read as per cent.
constexpr double near_one = 0.0953;

/// True of a ratio if one of its numbers is beyond this logarithm. They all take the same form.
bool reaches(const Effect& effect, double limit) {
  const auto far = [&](const Number& theta) {
    return is_finite(theta) && std::abs(*theta) > limit;
  };
  return is_ratio(effect) && (far(effect.estimate) || far(effect.low) || far(effect.high));
}

}  // namespace

bool is_finite(const Number& value) { return value && std::isfinite(*value); }

std::string round_trip(double value) {
  if (!std::isfinite(value)) return non_finite(value);
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string human(Number value, int digits) {
  if (!value) return no_number;
  if (!std::isfinite(*value)) return non_finite(*value);
  if (*value == 0) return "0";
  std::string text = fmt::format("{:.{}g}", *value, digits);
  // 1000 in two digits is not 1e+03.
  if (text.find("e+0") == std::string::npos || std::abs(*value) >= 1e6) return text;
  return fmt::format("{:.0f}", std::strtod(text.c_str(), nullptr));
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return non_finite(fraction);
  return human(100 * fraction, 3) + no_break_space + "%";
}

std::string confidence_text(double confidence) {
  if (!(confidence > 0 && confidence < 1)) return percent(confidence);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(1 - confidence))) - 2);
  return fmt::format("{:.{}f}{}%", 100 * confidence, decimals, no_break_space);
}

std::string with_sign(double value, bool relative) {
  const std::string text = magnitude(value, relative);
  return value > 0 ? "+" + text : text;
}

std::string magnitude(double value, bool relative) {
  return relative ? percent(value) : human(value);
}

std::string scientific(double log10_value) {
  if (!std::isfinite(log10_value)) return log10_value < 0 ? "0" : non_finite(log10_value);
  // Nobody reads the digits of such an exponent.
  if (log10_value < -1e6) return "below 1e-1000000";
  if (log10_value > 1e6) return "above 1e1000000";
  double exponent = std::floor(log10_value);
  double mantissa = std::pow(10.0, log10_value - exponent);
  // 9.96e-5 must not be printed as 10.0e-5.
  if (mantissa >= 9.95) {
    mantissa = 1;
    ++exponent;
  }
  return fmt::format("{:.1f}e{:.0f}", mantissa, exponent);
}

std::string p_text(Number p, Number log10_p) {
  // An event that is impossible under the claim has a logarithm of 300 digits.
  if (log10_p && std::isfinite(*log10_p) && *log10_p < -1e6) return "below 1e-1000000";
  if (log10_p && std::isfinite(*log10_p) && *log10_p < -4) return scientific(*log10_p);
  if (!p) return log10_p ? p_text(std::pow(10.0, *log10_p), std::nullopt) : no_number;
  if (!std::isfinite(*p)) return non_finite(*p);
  // A p-value that underflowed is stored as the least double, or as zero.
  if (*p >= 0 && *p < std::numeric_limits<double>::min()) return "below 1e-307";
  if (*p < 1e-4) return *p < 0 ? human(*p, 2) : scientific(std::log10(*p));
  // Two digits would turn 0.9996 into 1: a p-value near one is itself a finding.
  constexpr double near_one = 0.99, nearest = 0.9999;
  if (!(*p > near_one && *p < 1)) return fmt::format("{:.2g}", *p);
  return *p > nearest ? "above 0.9999" : human(*p);
}

std::string count_text(std::uint64_t count) {
  if (count < 10000) return fmt::format("{}", count);
  static constexpr std::array<const char*, 6> prefixes = {"k", "M", "G", "T", "P", "E"};
  double scaled = static_cast<double>(count) / 1000;
  std::size_t prefix = 0;
  while (scaled >= 999.5 && prefix + 1 < prefixes.size()) {
    scaled /= 1000;
    ++prefix;
  }
  const int decimals = scaled < 9.995 ? 2 : scaled < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}{}{}", scaled, decimals, no_break_space, prefixes[prefix]);
}

std::string counted(std::uint64_t count, const char* singular, const char* plural) {
  return fmt::format("{}{}{}", count_text(count), no_break_space, count == 1 ? singular : plural);
}

std::string in_commas(double whole) {
  std::string digits = fmt::format("{:.0f}", whole);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return non_finite(seconds);
  if (seconds == 0) return "0\u00A0s";
  if (seconds < 1) return human(1000 * seconds, 3) + no_break_space + "ms";
  if (seconds < 60) return human(seconds, 3) + no_break_space + "s";
  const double whole = std::round(seconds);
  if (whole < 3600)
    return fmt::format("{:.0f}\u00A0min\u00A0{:.0f}\u00A0s", std::floor(whole / 60),
                       std::fmod(whole, 60));
  return fmt::format("{:.0f}\u00A0h\u00A0{:.0f}\u00A0min", std::floor(whole / 3600),
                     std::floor(std::fmod(whole, 3600) / 60));
}

bool is_ratio(const Effect& effect) {
  return effect.quantity.starts_with("ln ") || effect.quantity.starts_with("ln(");
}

bool is_factor(const Effect& effect) { return reaches(effect, near_one); }

std::string factor_text(double theta) {
  // Three digits, or four near 1; beyond a double the power of ten comes from the logarithm.
  constexpr double largest = 700, near = 0.005;
  return std::abs(theta) < largest ? human(std::exp(theta), std::abs(theta) < near ? 4 : 3)
                                   : scientific(theta / std::numbers::ln10);
}

std::string effect_name(const Effect& effect) {
  if (!is_ratio(effect)) return effect.quantity;
  std::string name = effect.quantity.substr(3);
  if (effect.quantity[2] == '(' && name.ends_with(')')) name.pop_back();
  return name;
}

bool is_root_mean_square(const Effect& effect) {
  return effect.quantity.find("root mean square") != std::string::npos;
}

std::string theta_text(double theta, const Effect& effect) {
  if (is_root_mean_square(effect)) return magnitude(theta, effect.relative);
  if (!is_ratio(effect) || !std::isfinite(theta)) return with_sign(theta, effect.relative);
  return is_factor(effect) ? "×" + factor_text(theta) : with_sign(std::expm1(theta), true);
}

// A missing end lies at infinity.
bool lies_above(const Effect& effect, double theta) {
  return is_finite(effect.low) && *effect.low > theta;
}

bool lies_below(const Effect& effect, double theta) {
  return is_finite(effect.high) && *effect.high < theta;
}

std::string range_text(const Effect& effect) {
  const auto end = [&](const Number& value) { return theta_text(*value, effect); };
  if (is_finite(effect.low) && is_finite(effect.high)) {
    // An interval that is open at 0 begins with the least double.
    const bool open = *effect.low > 0 && *effect.low < 1e-300;
    const std::string low = open ? "above 0" : end(effect.low), high = end(effect.high);
    return low == high ? low : fmt::format("{} to {}", low, high);
  }
  if (is_finite(effect.low)) return "at least " + end(effect.low);
  return is_finite(effect.high) ? "at most " + end(effect.high) : "";
}

std::string effect_text(const Effect& effect) {
  if (!effect.estimate) return {};
  const std::string text = theta_text(*effect.estimate, effect);
  const std::string range = range_text(effect);
  return range.empty() ? text : fmt::format("{} ({})", text, range);
}

std::string named_range_text(const Effect& effect) {
  const std::string range = range_text(effect);
  if (range.empty()) return {};
  return fmt::format(" ({} interval: {})", confidence_text(effect.confidence), range);
}

std::string named_effect_text(const Effect& effect) {
  return effect.estimate ? theta_text(*effect.estimate, effect) + named_range_text(effect) : "";
}

std::string margin_text(double margin, const Effect& effect) {
  return size_text(std::abs(margin), effect);
}

std::string size_text(double theta, const Effect& effect) {
  if (!is_ratio(effect) || !std::isfinite(theta))
    return magnitude(std::abs(theta), effect.relative);
  if (!reaches(effect, std::numbers::ln2) && std::abs(theta) <= std::numbers::ln2)
    return percent(std::abs(std::expm1(theta)));
  return "a factor of " + factor_text(std::abs(theta));
}

}  // namespace assay::reports
