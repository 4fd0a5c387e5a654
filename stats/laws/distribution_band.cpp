#include "stats/laws/distribution_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/laws/band_walk.h"

namespace assay::stats {
namespace {

std::vector<double> equal_steps(std::size_t points) {
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

DistributionBand band_of(const char* caller, std::uint64_t n, std::size_t points,
                         double confidence) {
  check::at_least({caller, "n"}, n, 1);
  check::at_least({caller, "points"}, points, 2);
  check::inside_unit({caller, "confidence"}, confidence);
  const std::vector<double> z = equal_steps(points);
  DistributionBand band = widest(BandWalk::one_sample(n, z), confidence);
  for (std::size_t i = 0; i < z.size(); ++i) band.points[i].z = z[i];
  return band;
}

}  // namespace

DistributionBand ecdf_band(std::uint64_t n, std::size_t points, double confidence) {
  return band_of("ecdf_band", n, points, confidence);
}

double simultaneous_error(std::uint64_t n, std::size_t points, double confidence) {
  const auto gamma = [&](std::uint64_t values) {
    return band_of("simultaneous_error", values, points, confidence).gamma;
  };
  constexpr std::uint64_t most = 1000;
  // 1 / sqrt(most) is twice 1 / sqrt(4 most).
  return n <= most ? gamma(n) : 2 * gamma(4 * most) - gamma(most);
}

}  // namespace assay::stats
