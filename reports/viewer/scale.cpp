#include "reports/viewer/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace assay::reports {
namespace {

// Beyond this a difference of two doubles may overflow.
constexpr double largest = 1e300;

double decade(double value) { return std::pow(10.0, std::floor(std::log10(value))); }

double round_step(double rough) {
  const double power = decade(rough);
  const double mantissa = rough / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

std::string short_exponent(double value, int digits) {
  std::string text = fmt::format("{:.{}e}", value, digits);
  const std::size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return fmt::format("{}e{}", mantissa, std::stoi(text.substr(e + 1)));
}

}  // namespace

void Extent::include(double value) {
  if (!std::isfinite(value)) return;
  value = std::clamp(value, -largest, largest);
  range_.low = empty_ ? value : std::min(range_.low, value);
  range_.high = empty_ ? value : std::max(range_.high, value);
  empty_ = false;
}

void Extent::include(Number value) {
  if (value) include(*value);
}

Range Extent::range() const {
  const double size = std::max(std::abs(range_.low), std::abs(range_.high));
  const double least = std::max(1e-9 * size, 1e-290);
  if (range_.high - range_.low > least) return range_;
  const double margin = size > 1e-290 ? 0.1 * size : 1;
  return {range_.low - margin, range_.high + margin};
}

Range Extent::padded(double fraction) const {
  const Range range = this->range();
  const double margin = fraction * (range.high - range.low);
  return {range.low - margin, range.high + margin};
}

double Scale::operator()(double value) const {
  const bool logarithmic = d_.kind == Kind::logarithmic;
  if (std::isnan(value)) value = d_.domain.low;
  value = std::clamp(value, d_.domain.low, d_.domain.high);
  const double part =
      logarithmic ? std::log(value / d_.domain.low) / std::log(d_.domain.high / d_.domain.low)
                  : (value - d_.domain.low) / (d_.domain.high - d_.domain.low);
  return d_.pixels.low + part * (d_.pixels.high - d_.pixels.low);
}

std::vector<Tick> Scale::ticks(int wanted) const {
  return d_.kind == Kind::logarithmic ? logarithmic_ticks(wanted) : linear_ticks(wanted);
}

std::vector<Tick> Scale::linear_ticks(int wanted) const {
  const double step = round_step((d_.domain.high - d_.domain.low) / std::max(wanted, 1));
  std::vector<Tick> result;
  const double first = std::ceil(d_.domain.low / step);
  for (int i = 0; i <= 2 * wanted; ++i) {
    const double value = (first + i) * step;
    if (value > d_.domain.high) break;
    result.push_back({value, axis_label(value, step)});
  }
  return result;
}

std::vector<Tick> Scale::logarithmic_ticks(int wanted) const {
  const double first = std::ceil(std::log10(d_.domain.low) - 1e-9);
  const double last = std::floor(std::log10(d_.domain.high) + 1e-9);
  if (last - first < 1) return short_logarithmic_ticks(wanted);
  const double every = std::max(1.0, std::ceil((last - first + 1) / std::max(wanted, 1)));
  std::vector<Tick> result;
  for (double power = first; power <= last; power += every) {
    const double value = std::pow(10.0, power);
    result.push_back({value, axis_label(value, value)});
  }
  return result;
}

// Less than two powers of ten: 1, 2 and 5 times each, or where even these are rare, round numbers
// of a linear axis.
std::vector<Tick> Scale::short_logarithmic_ticks(int wanted) const {
  std::vector<Tick> result;
  for (double power = decade(d_.domain.low); power <= d_.domain.high; power *= 10) {
    for (const int multiple : {1, 2, 5}) {
      const double value = multiple * power;
      if (value >= d_.domain.low && value <= d_.domain.high)
        result.push_back({value, axis_label(value, power)});
    }
  }
  return result.size() < 2 ? linear_ticks(wanted) : result;
}

std::string axis_label(double value, double step) {
  if (std::abs(value) < step / 1e6) return "0";
  const double size = std::abs(value);
  if (size >= 1e5 || step < 1e-4) {
    const double digits = std::clamp(std::ceil(std::log10(size / step) - 1e-9), 0.0, 6.0);
    return short_exponent(value, static_cast<int>(digits));
  }
  const double decimals = std::max(0.0, -std::floor(std::log10(step) + 1e-9));
  return fmt::format("{:.{}f}", value, static_cast<int>(decimals));
}

}  // namespace assay::reports
