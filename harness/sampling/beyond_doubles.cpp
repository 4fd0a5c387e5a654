#include "harness/sampling/beyond_doubles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace assay::harness {
namespace {

/// A quick test that settles nearly all of an image's millions of elements.
bool are_ordinary(const stats::Moments& moments) {
  return moments.m2 > 1e-60 && moments.m2 < 1e60 && std::abs(moments.m3) < 1e90 &&
         moments.m4 > 1e-120 && moments.m4 < 1e120;
}

// Denormal numbers have lost their digits.
constexpr double least =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

std::string refusal(const std::string& name, double spread, const char* power) {
  return fmt::format(
      "the observations of `{}` spread over {:.3g}, whose {} power is beyond the numbers that "
      "a computer holds; give them in another unit",
      name, spread, power);
}

}  // namespace

std::string beyond_doubles(const stats::JointMoments& powers, const std::string& name) {
  const double highest = powers.sum(powers.known, 0);
  const bool sound = highest > least && std::ranges::all_of(powers.sums, [](double sum) {
                       return std::isfinite(sum);
                     });
  if (sound) return "";
  return refusal(name, powers.of_x.maximum - powers.of_x.minimum, "eighth");
}

std::string beyond_doubles(const stats::Moments& moments, const std::string& name) {
  if (moments.count < 2 || are_ordinary(moments)) return "";
  const double spread = moments.maximum - moments.minimum;
  const bool sound = moments.m2 * moments.m2 > least && std::isfinite(moments.m2) &&
                     std::isfinite(moments.m4) && moments.m4 > least &&
                     std::isfinite(moments.skewness()) && std::isfinite(moments.kurtosis());
  if (sound) return "";
  return refusal(name, spread, "fourth");
}

}  // namespace assay::harness
