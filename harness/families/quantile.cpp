#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "harness/families/families.h"
#include "harness/plan/sizes.h"
#include "harness/question/question.h"
#include "harness/theta/ask.h"
#include "harness/theta/theta.h"
#include "stats/basics/scores.h"
#include "stats/laws/quantile_test.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

using stats::Moments;

// ---- Evidence

std::vector<double> sorted(std::span<const double> values, double factor) {
  std::vector<double> copy(values.begin(), values.end());
  for (double& value : copy) value *= factor;
  return stats::sorted(std::move(copy));
}

double middle(const std::vector<double>& sorted, double probability) {
  return sorted[stats::sample_quantile_rank(sorted.size(), probability)];
}

Evidence against_number(const Seen& seen, std::vector<double> values) {
  const double probability = seen.question.test->claim.left.arguments[0];
  const double null = seen.reference().value;
  const bool relative = seen.relative();
  const double unit = relative ? std::abs(null) : 1;
  const auto at = [=](double theta) {
    return stats::quantile_test(stats::count_around(values, null + theta * unit), probability);
  };
  const auto interval = [=](double confidence) {
    return stats::map_ends(stats::quantile_interval(values, probability, confidence),
                           [=](double value) { return (value - null) / unit; });
  };
  return {.estimate = (middle(values, probability) - null) / unit,
          .at = at,
          .interval = interval,
          .quantity = relative ? "relative difference of the quantile from the reference"
                               : "difference of the quantile from the reference",
          .relative = relative};
}

/// Exact for every law.
Evidence quantile(const Seen& seen) {
  const Question& question = seen.question;
  std::vector<double> x = sorted(seen.data[0].values, 1);
  if (!question.of_two()) return against_number(seen, std::move(x));
  // The quantile of c y is c times that of y, c > 0.
  const std::vector<double> y = sorted(seen.data[1].values, question.factor);
  const double probability = question.test->claim.left.arguments[0];
  const double estimate = middle(x, probability) - middle(y, probability);
  const auto at = [x, y, probability](double theta) {
    return stats::quantile_compare(x, y, probability, theta);
  };
  const auto interval = [x, y, probability](double confidence) {
    return stats::quantile_difference_interval(x, y, probability, confidence);
  };
  return {
      .estimate = estimate, .at = at, .interval = interval, .quantity = "difference of quantiles"};
}

// ---- Sizes

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

// Fewer values beside a quantile do not show the density there.
constexpr std::size_t fewest_beside = 64;

/// Two standard errors of so many values, as a part of them.
double uncertain_part(std::size_t count) { return 2 / std::sqrt(static_cast<double>(count)); }

/// Slope of the distribution function over the distance, or as far as the fewest values reach.
double slope_beside(std::span<const double> distances, double distance, double total) {
  const auto beyond = std::ranges::upper_bound(distances, distance);
  const std::size_t count =
      std::max(static_cast<std::size_t>(beyond - distances.begin()), fewest_beside);
  const double reach = std::max(distance, distances[fewest_beside - 1]);
  return static_cast<double>(count) * (1 - uncertain_part(count)) / total / reach;
}

/// The same on the sparser side of a quantile that has this part of the law beyond it. Values are
/// in their order from that end. Excesses of the outermost over the next value count as generalised
/// Pareto, by their mean and variance (Hosking & Wallis 1987).
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

/// The same on the sparser side of the value at this rank.
double slope_around(std::span<const double> sorted, std::size_t rank, double distance) {
  std::vector<double> below, above;
  for (std::size_t i = rank; i-- > 0;) below.push_back(sorted[rank] - sorted[i]);
  for (const double value : sorted.subspan(rank + 1)) above.push_back(value - sorted[rank]);
  const double total = static_cast<double>(sorted.size());
  return std::min(slope_beside(below, distance, total), slope_beside(above, distance, total));
}

double observed_slope(std::vector<double> values, double probability, double distance) {
  values = stats::sorted(std::move(values));
  const std::size_t rank = stats::sample_quantile_rank(values.size(), probability);
  if (rank < fewest_beside) return slope_in_tail(values, probability, distance);
  if (rank + fewest_beside < values.size()) return slope_around(values, rank, distance);
  std::ranges::reverse(values);
  return slope_in_tail(values, 1 - probability, distance);
}

/// quantile_standard_deviation with the density that the pilot shows over this distance, on the
/// quantile's sparser side. Returns nullopt if the pilot does not show it.
std::optional<double> observed_deviation(std::span<const double> pilot, double probability,
                                         double distance) {
  std::vector<double> values(pilot.begin(), pilot.end());
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.size() < 4 * fewest_beside) return std::nullopt;
  const double slope = observed_slope(std::move(values), probability, distance);
  if (!(slope > 0) || !std::isfinite(slope)) return std::nullopt;
  return stats::quantile_standard_deviation(probability, slope);
}

// Cornish and Fisher's first term means nothing where it shrinks the deviation below this part.
constexpr double least_stretch = 0.2;

/// Deviation of one secondary. A mean of several primaries has a density by Cornish and Fisher's
/// first term.
double quantile_deviation(const TestOutcome& test, std::size_t subject, std::size_t channel,
                          double distance, const Pilots& pilots) {
  const double probability = test.question.test->claim.left.arguments[0];
  const PilotChannel pilot = pilot_channel(test.question, subject, channel, pilots);
  const double averaged = test.question.subjects[subject].averaged(test.plan.primaries[subject]);
  if (averaged == 1) {
    const auto observed = observed_deviation(pilot.values, probability, distance);
    if (observed) return *observed;
  }
  const double z = stats::normal_quantile({stats::Tail::lower, std::log(probability)});
  const double stretch = 1 + pilot.moments.skewness() / std::sqrt(averaged) * z / 3;
  return stats::quantile_standard_deviation(probability, normal_density(z)) *
         std::max(stretch, least_stretch) * std::sqrt(pilot.moments.variance() / averaged);
}

/// theta = v - r of the values' quantile v, over |r| if a margin is relative; of two, v - c w.
class QuantileTheta final : public Theta {
 public:
  QuantileTheta()
      : Theta({.of_single_values = true, .may_be_unbounded = true},
              {{"binomial", "exact: a quantile against a number", of_one, Keeps::values, quantile,
                exact_at_any_size},
               {"quantile", "exact: two quantiles", of_two, Keeps::values, quantile,
                exact_at_any_size}}) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override {
    Question question = Theta::bind(test, estimators);
    const ScaledQuantity* other = other_side(test.claim);
    if (other == nullptr) return question;
    const Location& where = other->quantity.where;
    if (other->quantity.arguments != test.claim.left.arguments) {
      refuse(where, "both quantiles must be of the same probability");
    }
    if (other->factor < 0) refuse(where, "the factor of a quantile must be above 0");
    return question;
  }

  void check_margin(const Question& question, const Margin& margin) const override {
    Theta::check_margin(question, margin);
    if (question.of_two()) require_absolute(margin, "two quantiles differ by a number");
  }

  bool is_relative(const Question& question, std::size_t) const override {
    return !question.of_two() && has_margin(*question.test, true);
  }

  /// The size is planned by the density at the quantile that the pilot shows. If it differs, the
  /// size is off by its ratio and the verdict may be inconclusive. The test is exact for every law.
  std::optional<std::uint64_t> secondaries_of(const TestOutcome& test, std::size_t channel,
                                              const ErrorShare& share,
                                              const Pilots& pilots) const override {
    const Question& question = test.question;
    const double unit = unit_of_theta(question, channel, 0);
    const Regions& regions = test.plan.regions[channel];
    const double distance = distance_of(regions) * unit;
    if (!(distance > 0)) return std::nullopt;
    double sd = quantile_deviation(test, 0, channel, distance, pilots);
    if (question.of_two()) {
      const double factor = std::abs(question.factor);
      sd = std::hypot(sd, factor * quantile_deviation(test, 1, channel, distance / factor, pilots));
    }
    if (!(sd > 0)) return std::nullopt;
    return whole_secondaries(stats::normal_sample_size(sd, {.allow = 0, .detect = distance},
                                                       planned_rates(share, regions)));
  }

  std::optional<double> marked(const Seen& seen) const override {
    if (seen.question.of_two()) return std::nullopt;
    return seen.reference().value;
  }

  std::string not_excluded(const ChannelOutcome& channel) const override {
    // A lower limit alone refutes a claim `<=`.
    const bool no_low = channel.regions.bounds_above() && !channel.effect.low;
    const bool no_high = channel.regions.bounds_below() && !channel.effect.high;
    if (no_low && no_high) return "quantile";
    if (no_low) return "smaller quantile";
    return no_high ? "larger quantile" : "";
  }
};

}  // namespace

const Theta& theta_of_quantiles() { return one<QuantileTheta>(); }

}  // namespace assay::harness
