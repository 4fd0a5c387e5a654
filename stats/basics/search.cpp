#include "stats/basics/search.h"

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace assay::stats {

std::pair<double, double> root_bracket(const Curve& f, double low, double high, unsigned digits) {
  std::uintmax_t iterations = 200;
  // Interpolation from an infinite value is no number.
  constexpr double most = 1e100;
  const auto finite = [&](double x) { return std::clamp(f(x), -most, most); };
  return boost::math::tools::toms748_solve(
      finite, low, high, boost::math::tools::eps_tolerance<double>(digits), iterations);
}

Maximum maximum(const Curve& f, double low, double high, int digits) {
  const auto [place, least] =
      boost::math::tools::brent_find_minima([&](double x) { return -f(x); }, low, high, digits);
  Maximum found{place, -least};
  for (const double end : {low, high}) {
    if (const double value = f(end); value > found.value) found = {end, value};
  }
  return found;
}

double root(const Curve& f, std::pair<double, double> ends, unsigned digits) {
  const auto [low, high] = std::minmax(ends.first, ends.second);
  const auto [below, above] = root_bracket(f, low, high, digits);
  return std::midpoint(below, above);
}

}  // namespace assay::stats
