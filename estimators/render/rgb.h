#pragma once

// Colours: radiance, reflectance or the weight of a path.

#include <algorithm>
#include <array>
#include <cstddef>

namespace assay::render {

/// Red, green and blue.
struct Rgb {
  std::array<double, 3> values = {};

  static constexpr Rgb grey(double x) { return {x, x, x}; }
  constexpr double operator[](std::size_t c) const { return values[c]; }
  constexpr double& operator[](std::size_t c) { return values[c]; }
  constexpr bool operator==(const Rgb&) const = default;
  constexpr Rgb& operator+=(const Rgb& b) {
    return *this = {values[0] + b[0], values[1] + b[1], values[2] + b[2]};
  }
};

inline constexpr std::array<const char*, 3> colours = {"red", "green", "blue"};

constexpr Rgb operator+(Rgb a, const Rgb& b) { return a += b; }
constexpr Rgb operator*(double x, const Rgb& a) { return {x * a[0], x * a[1], x * a[2]}; }
constexpr Rgb operator/(const Rgb& a, double x) { return {a[0] / x, a[1] / x, a[2] / x}; }
constexpr Rgb operator-(const Rgb& a, const Rgb& b) { return a + -1 * b; }
/// Channel by channel.
constexpr Rgb operator*(const Rgb& a, const Rgb& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
constexpr Rgb operator/(const Rgb& a, const Rgb& b) {
  return {a[0] / b[0], a[1] / b[1], a[2] / b[2]};
}
constexpr Rgb brighter(const Rgb& a, const Rgb& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])};
}
constexpr double sum(const Rgb& a) { return a[0] + a[1] + a[2]; }
constexpr double mean(const Rgb& a) { return sum(a) / 3; }
constexpr double largest(const Rgb& a) { return std::max({a[0], a[1], a[2]}); }
/// The luminance of linear sRGB primaries (ITU-R BT.709).
constexpr double luminance(const Rgb& a) { return 0.2126 * a[0] + 0.7152 * a[1] + 0.0722 * a[2]; }

}  // namespace assay::render
