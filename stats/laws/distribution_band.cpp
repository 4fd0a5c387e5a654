#include "stats/laws/distribution_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/laws/band_walk.h"

namespace assay::stats {
namespace {

std::vector<double> equal_steps(std::size_t points) {
  check::at_least({"distribution_band", "points"}, points, 2);
  std::vector<double> z;
  for (std::size_t i = 1; i < points; ++i) {
    z.push_back(static_cast<double>(i) / static_cast<double>(points));
  }
  return z;
}

double log_half(double gamma) { return std::log(gamma) - std::numbers::ln2; }

// The largest gamma whose band the path leaves with probability <= 1 - confidence, to 1e-6
// relative. It lies between Bonferroni's and the pointwise one.
DistributionBand widest(const BandWalk& walk, double confidence) {
  const double error = 1 - confidence;
  const double negligible = 1e-12 * error;
  const auto left = [&](double gamma) {
    return walk.exit(walk.inside(log_half(gamma)), negligible);
  };
  double kept = error / static_cast<double>(walk.points());
  double lost = std::min(error, 0.999);
  if (left(lost) <= error) {
    kept = lost;
  } else {
    while (lost > kept * (1 + 1e-6)) {
      const double middle = std::sqrt(kept * lost);
      (left(middle) <= error ? kept : lost) = middle;
    }
  }
  DistributionBand band;
  band.gamma = kept;
  band.coverage = 1 - left(kept);
  for (const BandWalk::Range& range : walk.inside(log_half(kept))) {
    band.points.push_back({.low = range.low, .high = range.high});
  }
  return band;
}

}  // namespace

DistributionBand ecdf_band(std::uint64_t n, std::size_t points, double confidence) {
  check::at_least({"ecdf_band", "n"}, n, 1);
  check::inside_unit({"ecdf_band", "confidence"}, confidence);
  const std::vector<double> z = equal_steps(points);
  DistributionBand band = widest(BandWalk::one_sample(n, z), confidence);
  for (std::size_t i = 0; i < z.size(); ++i) band.points[i].z = z[i];
  return band;
}

double simultaneous_error(std::uint64_t n, std::size_t points, double confidence) {
  constexpr std::uint64_t most = 1000;
  if (n <= most) return ecdf_band(n, points, confidence).gamma;
  // 1 / sqrt(most) is twice 1 / sqrt(4 most).
  return 2 * ecdf_band(4 * most, points, confidence).gamma -
         ecdf_band(most, points, confidence).gamma;
}

}  // namespace assay::stats
