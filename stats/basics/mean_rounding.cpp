#include "stats/basics/mean_rounding.h"

#include <cmath>
#include <limits>

namespace assay::stats {

double rounding_of_mean(const Moments& x) {
  if (!(x.m2 > 0)) return 0;
  const double size = std::abs(x.mean);
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return spacing / std::sqrt(12.0);
}

}  // namespace assay::stats
