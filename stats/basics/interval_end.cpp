#include "stats/basics/interval_end.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace assay::stats {

double interval_end(const std::function<double(double)>& excess, double centre, double first_step) {
  double inside = centre;
  double step = first_step;
  while (excess(centre + step) < 0) {
    inside = centre + step;
    step *= 2;
    if (std::abs(step) > 1e300) return std::copysign(std::numeric_limits<double>::infinity(), step);
  }
  // No number lies between, so the end is the centre to within its last digit.
  if (inside == centre + step) return inside;
  std::uintmax_t iterations = 200;
  // Values, not references.
  const auto [low, high] = std::minmax({inside, centre + step});
  const auto ends = boost::math::tools::toms748_solve(
      excess, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
  return std::midpoint(ends.first, ends.second);
}

}  // namespace assay::stats
