#pragma once

// Three numbers, one a colour channel. A grey scene carries the same number three times.

#include <algorithm>

namespace assay::paths {

struct Spectrum {
  double red = 0;
  double green = 0;
  double blue = 0;

  static constexpr Spectrum grey(double x) { return {x, x, x}; }
  constexpr bool operator==(const Spectrum&) const = default;
  constexpr Spectrum& operator+=(const Spectrum& s) {
    red += s.red;
    green += s.green;
    blue += s.blue;
    return *this;
  }
};

constexpr Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
constexpr Spectrum operator*(double x, const Spectrum& s) {
  return {x * s.red, x * s.green, x * s.blue};
}
constexpr Spectrum operator-(const Spectrum& a, const Spectrum& b) { return a + -1 * b; }
/// Channel by channel.
constexpr Spectrum operator*(const Spectrum& a, const Spectrum& b) {
  return {a.red * b.red, a.green * b.green, a.blue * b.blue};
}
constexpr Spectrum operator/(const Spectrum& a, const Spectrum& b) {
  return {a.red / b.red, a.green / b.green, a.blue / b.blue};
}
constexpr double sum(const Spectrum& s) { return s.red + s.green + s.blue; }
constexpr double mean(const Spectrum& s) { return sum(s) / 3; }
constexpr double largest(const Spectrum& s) { return std::max({s.red, s.green, s.blue}); }
/// The luminance of linear sRGB primaries (ITU-R BT.709).
constexpr double luminance(const Spectrum& s) {
  return 0.2126 * s.red + 0.7152 * s.green + 0.0722 * s.blue;
}

}  // namespace assay::paths
