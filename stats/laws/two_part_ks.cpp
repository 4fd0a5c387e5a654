#include "stats/laws/two_part_ks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "stats/laws/band_walk.h"

namespace assay::stats {
namespace {

struct Parts {
  std::uint64_t common;
  std::vector<double> rest;

  double share() const {
    return static_cast<double>(common) / static_cast<double>(common + rest.size());
  }
};

Parts split(std::span<const double> sorted, double value) {
  const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), value);
  Parts parts{static_cast<std::uint64_t>(end - begin), {sorted.begin(), begin}};
  parts.rest.insert(parts.rest.end(), end, sorted.end());
  return parts;
}

// Two-sided, of the number in x of the values that both have in common.
double log_p_of_counts(const Parts& x, std::uint64_t common, BandWalk::Pool pool) {
  if (common == pool.total) return 0;
  const BandWalk walk = BandWalk::two_samples(pool, {common});
  const double tail = std::min(walk.log_lower(0, x.common), walk.log_upper(0, x.common));
  return std::min(0.0, std::numbers::ln2 + tail);
}

}  // namespace

TwoLawsTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        const TwoSampleDistance& distance) {
  const std::uint64_t total = sorted_x.size() + sorted_y.size();
  const std::uint64_t common = distance.most_frequent.count;
  if (static_cast<double>(common) < least_common_share * static_cast<double>(total) || common < 2) {
    return {.result = kolmogorov_smirnov(distance)};
  }
  const double value = distance.most_frequent.value;
  const Parts x = split(sorted_x, value);
  const Parts y = split(sorted_y, value);
  const double of_counts = log_p_of_counts(x, common, {sorted_x.size(), total});
  TestResult rest{.statistic = 0, .distribution = {"bound", {}}};
  if (!x.rest.empty() && !y.rest.empty()) rest = kolmogorov_smirnov(ks_distance(x.rest, y.rest));
  const bool decides = of_counts < rest.log_p_upper;
  const double smaller = std::min(of_counts, rest.log_p_upper);
  return {.result = {.statistic = distance.distance(),
                     .distribution = {"bound", {}},
                     .log_p_lower = 0,
                     .log_p_upper = std::min(0.0, std::numbers::ln2 + smaller),
                     .exactness = rest.exactness},
          .common = CommonValue{
              .value = value, .difference = std::abs(x.share() - y.share()), .decides = decides}};
}

}  // namespace assay::stats
