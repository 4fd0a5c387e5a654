#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <ranges>
#include <utility>

namespace assay::stats {

// Internal. Searches on an interval.

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

// The maximum on [low, high], ends included, of a function that has one (Brent 1973). Its place is
// known to so many binary digits, half of a double's at most.
struct Maximum {
  double place = 0;
  double value = 0;
};
Maximum maximum(const Curve& f, double low, double high, int digits = 26);

// The bracket to which so many binary digits narrow [low, high], at whose ends f has different
// signs (Alefeld, Potra & Shi 1995).
std::pair<double, double> root_bracket(const Curve& f, double low, double high, unsigned digits);

// The middle of that bracket, for ends in any order.
double root(const Curve& f, std::pair<double, double> ends, unsigned digits);

}  // namespace assay::stats
