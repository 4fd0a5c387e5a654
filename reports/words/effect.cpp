#include "reports/words/effect.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "reports/words/number.h"

namespace assay::reports {
namespace {

bool bounded(const Number& end) { return end && std::isfinite(*end); }

// Factors near one are read as per cent; all numbers of one effect take the same form.
bool near_one(const Effect& effect) {
  const auto near = [](const Number& theta) {
    return !bounded(theta) || std::abs(*theta) <= std::numbers::ln2;
  };
  return near(effect.estimate) && near(effect.low) && near(effect.high);
}

std::string factor(double log_ratio) {
  // Three digits of a double; beyond its range the power of ten is written from the logarithm.
  constexpr double largest = 700;
  return std::abs(log_ratio) < largest ? human(std::exp(log_ratio), 3)
                                       : scientific(log_ratio / std::numbers::ln10);
}

}  // namespace

bool is_ratio(const Effect& effect) {
  return effect.quantity.starts_with("ln ") || effect.quantity.starts_with("ln(");
}

std::string effect_name(const Effect& effect) {
  if (!is_ratio(effect)) return effect.quantity;
  std::string name = effect.quantity.substr(3);
  if (effect.quantity[2] == '(' && name.ends_with(')')) name.pop_back();
  return name;
}

std::string theta_text(double theta, const Effect& effect) {
  if (!is_ratio(effect) || !std::isfinite(theta)) return with_sign(theta, effect.relative);
  return near_one(effect) ? with_sign(std::expm1(theta), true) : "×" + factor(theta);
}

std::string interval_text(const Effect& effect) {
  const auto end = [&](const Number& value) { return theta_text(*value, effect); };
  if (bounded(effect.low) && bounded(effect.high))
    return fmt::format("[{}, {}]", end(effect.low), end(effect.high));
  if (bounded(effect.low)) return fmt::format("[from {}]", end(effect.low));
  return bounded(effect.high) ? fmt::format("[to {}]", end(effect.high)) : std::string();
}

std::string interval_name(const Effect& effect) {
  return interval_text(effect).empty() ? std::string()
                                       : confidence_text(effect.confidence) + " interval";
}

std::string effect_text(const Effect& effect) {
  if (!effect.estimate) return {};
  const std::string text = theta_text(*effect.estimate, effect);
  const std::string interval = interval_text(effect);
  return interval.empty() ? text : fmt::format("{} {}", text, interval);
}

std::string named_effect_text(const Effect& effect) {
  const std::string text = effect_text(effect), name = interval_name(effect);
  return text.empty() || name.empty() ? text : fmt::format("{} ({})", text, name);
}

std::string margin_text(double margin, const Effect& effect) {
  return size_text(std::abs(margin), effect);
}

std::string size_text(double theta, const Effect& effect) {
  if (!is_ratio(effect) || !std::isfinite(theta))
    return magnitude(std::abs(theta), effect.relative);
  if (near_one(effect) && std::abs(theta) <= std::numbers::ln2)
    return percent(std::abs(std::expm1(theta)));
  return "a factor of " + factor(std::abs(theta));
}

}  // namespace assay::reports
