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

std::vector<std::uint64_t> equal_ranks(std::uint64_t total, std::size_t points) {
  std::vector<std::uint64_t> ranks;
  for (const double z : equal_steps(points)) {
    const auto rank = static_cast<std::uint64_t>(std::round(z * static_cast<double>(total)));
    if (rank > 0 && rank < total && (ranks.empty() || rank > ranks.back())) ranks.push_back(rank);
  }
  return ranks;
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

BandTest test_path(const BandWalk& walk, const std::vector<std::uint64_t>& counts) {
  double smallest = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double tail = std::min(walk.log_lower(i, counts[i]), walk.log_upper(i, counts[i]));
    if (tail < smallest) {
      smallest = tail;
      worst = i;
    }
  }
  BandTest result;
  result.count = counts[worst];
  const double log_gamma = std::min(0.0, smallest + std::numbers::ln2);
  result.test = {std::exp(log_gamma), {"bound", {}}, 0, 0, Exactness::exact};
  if (log_gamma == 0) return result;
  // Counts whose tail equals the observed one have left the band too. Rounding of factorials, 1e-10
  // of a tail at n = 1e5, must not keep them in.
  const double log_tail = smallest + 1e-9;
  const BandWalk::Range range = walk.inside(worst, log_tail);
  result.worst = {.low = range.low, .high = range.high};
  result.worst.z = static_cast<double>(worst);
  const double bonferroni = log_gamma + std::log(static_cast<double>(walk.points()));
  constexpr double deep = -460;  // ln 1e-200
  result.test.log_p_upper = bonferroni;
  if (log_gamma >= deep) {
    const double left = walk.exit(walk.inside(log_tail), 1e-16 * std::exp(log_gamma));
    result.test.log_p_upper = std::min(bonferroni, std::log(left));
  }
  result.test.log_p_upper = std::min(0.0, result.test.log_p_upper);
  return result;
}

std::uint64_t count_up_to(std::span<const double> sorted, double value) {
  return static_cast<std::uint64_t>(std::upper_bound(sorted.begin(), sorted.end(), value) -
                                    sorted.begin());
}

void check_sorted(std::span<const double> sorted) {
  check::at_least({"band_test", "values"}, sorted.size(), 1);
  check::finite({"band_test", "smallest value"}, sorted.front());
  check::finite({"band_test", "largest value"}, sorted.back());
  if (!std::is_sorted(sorted.begin(), sorted.end())) {
    check::fail({"band_test", "values"}, sorted.size(), "sorted ascending");
  }
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

DistributionBand ecdf_band(TwoSizes sizes, std::size_t points, double confidence) {
  check::at_least({"ecdf_band", "size of x"}, sizes.m, 1);
  check::at_least({"ecdf_band", "size of y"}, sizes.n, 1);
  check::inside_unit({"ecdf_band", "confidence"}, confidence);
  const std::uint64_t total = sizes.m + sizes.n;
  const auto ranks = equal_ranks(total, points);
  DistributionBand band = widest(BandWalk::two_samples({sizes.m, total}, ranks), confidence);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    band.points[i].rank = ranks[i];
    band.points[i].z = static_cast<double>(ranks[i]) / static_cast<double>(total);
  }
  return band;
}

double simultaneous_error(std::uint64_t n, std::size_t points, double confidence) {
  constexpr std::uint64_t most = 1000;
  if (n <= most) return ecdf_band(n, points, confidence).gamma;
  // 1 / sqrt(most) is twice 1 / sqrt(4 most).
  return 2 * ecdf_band(4 * most, points, confidence).gamma -
         ecdf_band(most, points, confidence).gamma;
}

BandTest band_test(std::span<const double> sorted_uniforms, std::size_t points) {
  check_sorted(sorted_uniforms);
  check::unit({"band_test", "smallest value"}, sorted_uniforms.front());
  check::unit({"band_test", "largest value"}, sorted_uniforms.back());
  const std::vector<double> z = equal_steps(points);
  std::vector<std::uint64_t> counts;
  for (const double value : z) counts.push_back(count_up_to(sorted_uniforms, value));
  BandTest result = test_path(BandWalk::one_sample(sorted_uniforms.size(), z), counts);
  result.worst.z = z[static_cast<std::size_t>(result.worst.z)];
  return result;
}

BandTest band_test(std::span<const double> sorted_x, std::span<const double> sorted_y,
                   std::size_t points) {
  check_sorted(sorted_x);
  check_sorted(sorted_y);
  std::vector<double> pooled(sorted_x.size() + sorted_y.size());
  std::merge(sorted_x.begin(), sorted_x.end(), sorted_y.begin(), sorted_y.end(), pooled.begin());
  std::vector<std::uint64_t> ranks;
  std::vector<std::uint64_t> counts;
  for (const std::uint64_t rank : equal_ranks(pooled.size(), points)) {
    const double value = pooled[rank - 1];
    const std::uint64_t end = count_up_to(pooled, value);
    if (end == pooled.size() || (!ranks.empty() && end == ranks.back())) continue;
    ranks.push_back(end);
    counts.push_back(count_up_to(sorted_x, value));
  }
  BandTest result;
  if (ranks.empty()) {
    result.test = {1, {"bound", {}}, 0, 0, Exactness::exact};
    return result;
  }
  result = test_path(BandWalk::two_samples({sorted_x.size(), pooled.size()}, ranks), counts);
  const auto worst = static_cast<std::size_t>(result.worst.z);
  result.worst.rank = ranks[worst];
  result.worst.z = static_cast<double>(ranks[worst]) / static_cast<double>(pooled.size());
  return result;
}

}  // namespace assay::stats
