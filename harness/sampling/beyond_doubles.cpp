#include "harness/sampling/beyond_doubles.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace assay::harness {
namespace {

/// A quick test that settles nearly all of an image's millions of elements.
bool are_ordinary(const stats::Moments& moments) {
  return moments.m2 > 1e-60 && moments.m2 < 1e60 && std::abs(moments.m3) < 1e90 &&
         moments.m4 > 1e-120 && moments.m4 < 1e120;
}

}  // namespace

std::string beyond_doubles(const stats::Moments& moments, const std::string& name) {
  if (moments.count < 2 || are_ordinary(moments)) return "";
  const double spread = moments.maximum - moments.minimum;
  // Denormal numbers have lost their digits.
  const double least = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  const bool sound = moments.m2 * moments.m2 > least && std::isfinite(moments.m2) &&
                     std::isfinite(moments.m4) && moments.m4 > least &&
                     std::isfinite(moments.skewness()) && std::isfinite(moments.kurtosis());
  if (sound) return "";
  return fmt::format(
      "the observations of `{}` spread over {:.3g}, whose fourth power is beyond the numbers that "
      "a computer holds; give them in another unit",
      name, spread);
}

}  // namespace assay::harness
