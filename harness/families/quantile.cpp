#include <cmath>
#include <utility>

#include "harness/families/families.h"
#include "harness/theta/ask.h"
#include "stats/basics/scores.h"
#include "stats/laws/quantile_test.h"

namespace assay::harness {
namespace {

std::vector<double> sorted(std::span<const double> values, double factor) {
  std::vector<double> copy(values.begin(), values.end());
  for (double& value : copy) value *= factor;
  return stats::sorted(std::move(copy));
}

/// Exact for every law.
Evidence quantile(const Seen& seen) {
  const Question& question = seen.question;
  const double probability = question.test->claim.left.arguments[0];
  std::vector<double> x = sorted(seen.data[0].values, 1);
  Evidence evidence;
  if (question.of_two()) {
    // The quantile of c y is c times that of y, c > 0.
    std::vector<double> y = sorted(seen.data[1].values, question.factor);
    evidence = stats::quantile_evidence(std::move(x), std::move(y), probability);
    evidence.quantity = "difference of quantiles";
    return evidence;
  }
  const double null = seen.reference().value;
  const bool relative = seen.relative();
  evidence =
      stats::quantile_evidence(std::move(x), probability, null, relative ? std::abs(null) : 1);
  evidence.quantity = relative ? "relative difference of the quantile from the reference"
                               : "difference of the quantile from the reference";
  evidence.relative = relative;
  return evidence;
}

double quantile_deviation(const TestOutcome& test, std::size_t subject, std::size_t channel,
                          double distance, const Pilots& pilots) {
  const double probability = test.question.test->claim.left.arguments[0];
  const ChannelData pilot = pilot_channel(test.question, subject, channel, pilots);
  const double averaged = test.question.subjects[subject].averaged(test.plan.primaries[subject]);
  if (averaged == 1) {
    const auto observed = stats::observed_quantile_deviation(pilot.values, probability, distance);
    if (observed) return *observed;
  }
  return stats::quantile_deviation_of_means(pilot.moments, averaged, probability);
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
                                              const stats::ErrorRates& rates,
                                              const Pilots& pilots) const override {
    const Question& question = test.question;
    const double unit = unit_of_theta(question, channel, 0);
    const double distance = distance_of(test.plan.regions[channel]) * unit;
    double sd = quantile_deviation(test, 0, channel, distance, pilots);
    if (question.of_two()) {
      const double factor = std::abs(question.factor);
      sd = std::hypot(sd, factor * quantile_deviation(test, 1, channel, distance / factor, pilots));
    }
    if (!(sd > 0)) return std::nullopt;
    return whole_secondaries(
        stats::normal_sample_size(sd, {.allow = 0, .detect = distance}, rates));
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
