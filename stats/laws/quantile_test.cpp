#include "stats/laws/quantile_test.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Sorted = std::span<const double>;

double sample_quantile(Sorted sorted, double probability) {
  return sorted[sample_quantile_rank(sorted.size(), probability)];
}

std::vector<double> moved(Sorted sorted, double offset) {
  std::vector<double> all(sorted.begin(), sorted.end());
  for (double& value : all) value += offset;
  return all;
}

// The largest product over v of two probabilities. P(so many of `lower` below v) falls with v, and
// P(so few of `upper` up to v) rises. The counts change only at observations, so the largest is
// taken at one. A range of observations cannot exceed the first factor at its start times the
// second at its end. That prunes the search.
class LargestProduct {
 public:
  LargestProduct(Sorted lower, Sorted upper, double probability)
      : lower_(lower), upper_(upper), probability_(probability) {
    std::ranges::merge(lower, upper, std::back_inserter(splits_));
  }

  double logarithm() {
    search(0, splits_.size() - 1);
    return largest_;
  }

 private:
  double first(std::size_t i) const {
    return binomial_upper(count_below(lower_, splits_[i]), {lower_.size(), probability_});
  }
  double second(std::size_t i) const {
    return binomial_lower(count_up_to(upper_, splits_[i]), {upper_.size(), probability_});
  }
  void search(std::size_t begin, std::size_t end) {
    if (first(begin) + second(end) <= largest_) return;
    const std::size_t middle = std::midpoint(begin, end);
    largest_ = std::max(largest_, first(middle) + second(middle));
    if (middle > begin) search(begin, middle - 1);
    if (middle < end) search(middle + 1, end);
  }

  Sorted lower_;
  Sorted upper_;
  double probability_;
  std::vector<double> splits_;
  double largest_ = -infinity;
};

double log_p_below(Sorted lower, Sorted upper, double probability) {
  const double log_c =
      std::max(special::lowest_log(), LargestProduct(lower, upper, probability).logarithm());
  // Fisher's combination of two independent p-values: c (1 - ln c).
  return special::clamp_log(log_c + std::log1p(-log_c));
}

}  // namespace

QuantileCounts count_around(std::span<const double> sorted, double value) {
  check::sorted("count_around", sorted);
  check::finite({"count_around", "value"}, value);
  return {count_below(sorted, value), count_up_to(sorted, value), sorted.size()};
}

TestResult quantile_test(const QuantileCounts& counts, double probability) {
  check::at_least({"quantile_test", "n"}, counts.n, 1);
  check::inside_unit({"quantile_test", "probability"}, probability);
  check::at_least({"quantile_test", "values up to v"}, counts.at_most, counts.below);
  check::at_least({"quantile_test", "n"}, counts.n, counts.at_most);
  const double n = static_cast<double>(counts.n);
  const Trials trials{counts.n, probability};
  const double share = static_cast<double>(counts.below + counts.at_most) / 2 / n;
  return {probability - share,
          {"binomial", {n, probability}},
          binomial_upper(counts.below, trials),
          binomial_lower(counts.at_most, trials)};
}

Interval quantile_interval(std::span<const double> sorted, double probability, double confidence) {
  check::sorted("quantile_interval", sorted);
  check::inside_unit({"quantile_interval", "probability"}, probability);
  check::inside_unit({"quantile_interval", "confidence"}, confidence);
  const std::uint64_t n = sorted.size();
  const double log_level = std::log((1 - confidence) / 2);
  // The smallest k with P(K <= k) above the level, the lower critical count.
  const auto smallest_kept = [&](double p) {
    return smallest_whole(0, n, [&](std::uint64_t count) {
      return binomial_lower(count, {n, p}) > log_level;
    });
  };
  const std::uint64_t fewest = smallest_kept(probability);
  const std::uint64_t most = n - smallest_kept(1 - probability);
  return {fewest == 0 ? -infinity : sorted[fewest - 1], most == n ? infinity : sorted[most],
          confidence};
}

TestResult quantile_compare(std::span<const double> sorted_x, std::span<const double> sorted_y,
                            double probability, double offset) {
  check::sorted("quantile_compare", sorted_x);
  check::sorted("quantile_compare", sorted_y);
  check::inside_unit({"quantile_compare", "probability"}, probability);
  check::finite({"quantile_compare", "offset"}, offset);
  const std::vector<double> y = moved(sorted_y, offset);
  return {sample_quantile(sorted_x, probability) - sample_quantile(y, probability),
          {"bound", {}},
          log_p_below(sorted_x, y, probability),
          log_p_below(y, sorted_x, probability)};
}

Interval quantile_difference_interval(std::span<const double> sorted_x,
                                      std::span<const double> sorted_y, double probability,
                                      double confidence) {
  check::inside_unit({"quantile_difference_interval", "confidence"}, confidence);
  const double log_level = std::log((1 - confidence) / 2);
  check::inside_unit({"quantile_difference_interval", "probability"}, probability);
  check::sorted("quantile_difference_interval", sorted_x);
  check::sorted("quantile_difference_interval", sorted_y);
  const auto rejected_above = [&](double offset) {
    return log_p_below(sorted_x, moved(sorted_y, offset), probability) <= log_level;
  };
  const auto rejected_below = [&](double offset) {
    return log_p_below(moved(sorted_y, offset), sorted_x, probability) <= log_level;
  };
  const double middle =
      sample_quantile(sorted_x, probability) - sample_quantile(sorted_y, probability);
  // Further apart than any two values, so nothing can be more extreme.
  const double reach = sorted_x.back() - sorted_x.front() + sorted_y.back() - sorted_y.front() + 1;
  const auto end = [&](const auto& rejected, double outside) {
    if (!rejected(outside)) return std::copysign(infinity, outside - middle);
    return halved_between(middle, outside, rejected).inside;
  };
  return {end(rejected_below, middle - reach), end(rejected_above, middle + reach), confidence};
}

Evidence quantile_evidence(std::vector<double> sorted, double probability, double null,
                           double unit) {
  const double middle = sample_quantile(sorted, probability);
  const auto values = std::make_shared<const std::vector<double>>(std::move(sorted));
  return {.estimate = (middle - null) / unit,
          .at =
              [=](double theta) {
                return quantile_test(count_around(*values, null + theta * unit), probability);
              },
          .interval = [=](double confidence) -> Interval {
            const Interval of = quantile_interval(*values, probability, confidence);
            return {(of.low - null) / unit, (of.high - null) / unit, confidence};
          }};
}

Evidence quantile_evidence(std::vector<double> sorted_x, std::vector<double> sorted_y,
                           double probability) {
  const auto x = std::make_shared<const std::vector<double>>(std::move(sorted_x));
  const auto y = std::make_shared<const std::vector<double>>(std::move(sorted_y));
  return {.estimate = sample_quantile(*x, probability) - sample_quantile(*y, probability),
          .at = [=](double theta) { return quantile_compare(*x, *y, probability, theta); },
          .interval =
              [=](double confidence) {
                return quantile_difference_interval(*x, *y, probability, confidence);
              }};
}

double quantile_standard_deviation(double probability, double density) {
  check::inside_unit({"quantile_standard_deviation", "probability"}, probability);
  check::positive({"quantile_standard_deviation", "density"}, density);
  return std::sqrt(probability * (1 - probability)) / density;
}

std::size_t sample_quantile_rank(std::size_t count, double probability) {
  check::at_least({"sample_quantile_rank", "count"}, count, 1);
  const double n = static_cast<double>(count);
  // .29 * 100 is 28.999999999999996.
  return static_cast<std::size_t>(std::min(n - 1, std::floor(probability * n * (1 + 1e-14))));
}

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
