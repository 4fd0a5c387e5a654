#include "stats/mean_rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/check.h"

namespace assay::stats {

double rounding_of_mean(const Moments& x, std::uint64_t block) {
  check::at_least({"rounding_of_mean", "block"}, block, 1);
  if (!(x.m2 > 0)) return 0;
  const double size = std::abs(x.mean);
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  const double n = static_cast<double>(x.count);
  const double in_block = std::min(static_cast<double>(block), n);
  const double blocks = n / in_block;
  return spacing / 6 * std::sqrt(in_block / blocks + blocks);
}

}  // namespace assay::stats
