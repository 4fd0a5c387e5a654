#include "stats/basics/search.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <numeric>

namespace assay::stats {

std::pair<double, double> root_bracket(const Curve& f, double low, double high, unsigned digits) {
  std::uintmax_t iterations = 200;
  // Interpolation from an infinite value is no number.
  constexpr double most = 1e100;
  const auto finite = [&](double x) { return std::clamp(f(x), -most, most); };
  return boost::math::tools::toms748_solve(
      finite, low, high, boost::math::tools::eps_tolerance<double>(digits), iterations);
}

double root(const Curve& f, std::pair<double, double> ends, unsigned digits) {
  const auto [low, high] = std::minmax(ends.first, ends.second);
  const auto [below, above] = root_bracket(f, low, high, digits);
  return std::midpoint(below, above);
}

}  // namespace assay::stats
