#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <ranges>
#include <utility>

namespace assay::stats {

// Internal. Searches on an interval.

// The largest value of f seen on [low, high], and the remaining interval.
struct GoldenSection {
  double low = 0;
  double high = 0;
  double largest = 0;
};

// Searches a function with one maximum on [low, high], ends included, by golden sections (Kiefer
// 1953). It stops at `width` or where no point lies between the ends. 90 sections leave 1e-19.
template <class Function>
GoldenSection golden_section(const Function& f, double low, double high, double width = 0) {
  constexpr double ratio = 0.6180339887498949;
  double left = high - ratio * (high - low);
  double right = low + ratio * (high - low);
  double at_left = f(left);
  double at_right = f(right);
  double largest = std::max({f(low), f(high), at_left, at_right});
  for (int step = 0; step < 90 && high - low > width && low < left && right < high; ++step) {
    if (at_left < at_right) {
      low = left;
      left = right;
      at_left = at_right;
      right = low + ratio * (high - low);
      at_right = f(right);
    } else {
      high = right;
      right = left;
      at_right = at_left;
      left = high - ratio * (high - low);
      at_left = f(left);
    }
    largest = std::max({largest, at_left, at_right});
  }
  return {low, high, largest};
}

// The smallest whole number in [low, high) that is enough, or `high`. All above it must be enough.
template <class Enough>
std::uint64_t smallest_whole(std::uint64_t low, std::uint64_t high, const Enough& enough) {
  return *std::ranges::lower_bound(std::views::iota(low, high), true, {}, enough);
}

// An interval from a point inside to one outside, halved until no double lies between its ends.
struct Halved {
  double inside = 0;
  double outside = 0;
};

template <class IsOutside>
Halved halved_between(double inside, double outside, const IsOutside& is_outside) {
  while (true) {
    const double middle = std::midpoint(inside, outside);
    if (middle == inside || middle == outside) return {inside, outside};
    (is_outside(middle) ? outside : inside) = middle;
  }
}

using Curve = std::function<double(double)>;

// The bracket to which so many binary digits narrow [low, high], at whose ends f has different
// signs (Alefeld, Potra & Shi 1995).
std::pair<double, double> root_bracket(const Curve& f, double low, double high, unsigned digits);

// The middle of that bracket, for ends in any order.
double root(const Curve& f, std::pair<double, double> ends, unsigned digits);

}  // namespace assay::stats
