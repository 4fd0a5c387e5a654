#include "stats/laws/quantile_deviation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "stats/basics/scores.h"
#include "stats/laws/quantile_test.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

// Fewer values beside a quantile do not show the density there.
constexpr std::size_t fewest_beside = 64;

// Two standard errors of so many values, as a part of them.
double uncertain_part(std::size_t count) { return 2 / std::sqrt(static_cast<double>(count)); }

// Slope of the distribution function over the distance, or as far as the fewest values reach.
double slope_beside(std::span<const double> distances, double distance, double total) {
  const auto beyond = std::ranges::upper_bound(distances, distance);
  const std::size_t count =
      std::max(static_cast<std::size_t>(beyond - distances.begin()), fewest_beside);
  const double reach = std::max(distance, distances[fewest_beside - 1]);
  return static_cast<double>(count) * (1 - uncertain_part(count)) / total / reach;
}

// The same on the sparser side of a quantile that has this part of the law beyond it. Values are in
// their order from that end.
double slope_in_tail(std::span<const double> values, double part, double distance) {
  constexpr std::size_t outermost = 2 * fewest_beside;
  Moments excesses;
  for (const double value : values.first(outermost)) {
    excesses.add(std::abs(value - values[outermost]));
  }
  const double shape = (1 - excesses.mean * excesses.mean / excesses.variance()) / 2;
  const double scale = excesses.mean * (1 - shape);
  const auto survival = [&](double excess) {
    return std::pow(std::max(0.0, 1 + shape * excess / scale), -1 / shape);
  };
  const double share = static_cast<double>(outermost) / static_cast<double>(values.size());
  const double beyond = part / share;
  const double quantile = scale / shape * (std::pow(beyond, -shape) - 1);
  const double inner = std::min(distance, quantile);
  const double outwards = (beyond - survival(quantile + distance)) / distance;
  const double inwards = (survival(quantile - inner) - beyond) / inner;
  return share * std::min(outwards, inwards) * (1 - uncertain_part(outermost));
}

// The same on the sparser side of the value at this rank.
double slope_around(std::span<const double> sorted, std::size_t rank, double distance) {
  std::vector<double> below, above;
  for (std::size_t i = rank; i-- > 0;) below.push_back(sorted[rank] - sorted[i]);
  for (const double value : sorted.subspan(rank + 1)) above.push_back(value - sorted[rank]);
  const double total = static_cast<double>(sorted.size());
  return std::min(slope_beside(below, distance, total), slope_beside(above, distance, total));
}

double observed_slope(std::vector<double> values, double probability, double distance) {
  values = sorted(std::move(values));
  const std::size_t rank = sample_quantile_rank(values.size(), probability);
  if (rank < fewest_beside) return slope_in_tail(values, probability, distance);
  if (rank + fewest_beside < values.size()) return slope_around(values, rank, distance);
  std::ranges::reverse(values);
  return slope_in_tail(values, 1 - probability, distance);
}

// Cornish and Fisher's first term means nothing where it shrinks the deviation below this part.
constexpr double least_stretch = 0.2;

}  // namespace

std::optional<double> observed_quantile_deviation(std::span<const double> sample,
                                                  double probability, double distance) {
  std::vector<double> values(sample.begin(), sample.end());
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.size() < 4 * fewest_beside) return std::nullopt;
  const double slope = observed_slope(std::move(values), probability, distance);
  if (!(slope > 0) || !std::isfinite(slope)) return std::nullopt;
  return quantile_standard_deviation(probability, slope);
}

double quantile_deviation_of_means(const Moments& values, double averaged, double probability) {
  const double z = normal_quantile({Tail::lower, std::log(probability)});
  const double stretch = 1 + values.skewness() / std::sqrt(averaged) * z / 3;
  return quantile_standard_deviation(probability, normal_density(z)) *
         std::max(stretch, least_stretch) * std::sqrt(values.variance() / averaged);
}

}  // namespace assay::stats
