#include "stats/variances/slope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "harness/suite/suite.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {
namespace {

using stats::Moments;
using stats::SlopeData;
using stats::SlopePoint;

// The gate is red below this p, however small the test's level.
constexpr double least_p_of_fit = 1e-5;

bool of_costs(const Question& question) { return question.test->claim.left.row->counts_cost; }

bool of_logarithms(const Question& question) {
  return question.is().of_spread || of_costs(question);
}

/// The cost or the variance of a primary at point i.
stats::Influence influence_of(const Seen& seen, std::size_t i) {
  if (of_costs(seen.question)) return cost_of(seen, i);
  stats::Influence influence = stats::influence_of_variance(powers_of_values(seen.data[i]));
  influence.log_value += std::log(seen.question.subjects[i].averaged(seen.data[i].primaries));
  return influence;
}

SlopeData points_of(const Seen& seen) {
  const Question& question = seen.question;
  const bool logarithms = of_logarithms(question);
  // One reference for all points shifts them together by its error.
  const bool is_shared = question.has_reference_subject || question.test->reference_number ||
                         question.test->over->parameter == "primaries";
  SlopeData slope{.scale = logarithms ? stats::SlopeScale::logarithms : stats::SlopeScale::values};
  for (std::size_t i = 0; i < question.compared(); ++i) {
    SlopePoint point{.size = question.sizes[i]};
    if (logarithms) {
      const stats::Influence influence = influence_of(seen, i);
      point.estimate = influence.log_value;
      point.standard_error = influence.relative.standard_error();
    } else {
      point.estimate = seen.moments(i).mean;
      point.standard_error = seen.moments(i).standard_error();
    }
    if (!question.truths.empty()) {  // each point of a bias has one
      const Constant truth = truth_of(seen, i);
      point.estimate -= truth.value;
      if (is_shared) {
        slope.reference_error = truth.standard_error;
      } else {
        point.standard_error = std::hypot(point.standard_error, truth.standard_error);
      }
    }
    slope.points.push_back(point);
  }
  return slope;
}

/// Theta is the exponent minus the claimed one. Biases and means are fitted as they are, variances
/// and costs by their logarithms (stats/variances/slope.h). Costs that never vary are exact.
Evidence slope(const Seen& seen) {
  Evidence evidence = stats::slope_evidence(points_of(seen), seen.reference().value);
  evidence.quantity = "difference from the claimed slope";
  return evidence;
}

/// Gates of the points whose logarithms are fitted, on the skewness of their influence values.
std::vector<Gate> skewness_gates(const Seen& seen, double critical) {
  const Question& question = seen.question;
  std::vector<Gate> gates;
  // Channels share their costs: the first has the gates.
  if (!of_logarithms(question) || (of_costs(question) && seen.channel != 0)) return gates;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    Moments relative = influence_of(seen, i).relative;
    if (!(relative.m2 > 0)) continue;
    // The bend of the logarithm takes 3/2 of their standard deviation off the skewness g1.
    relative.m3 -= 1.5 * relative.m2 * relative.m2 / static_cast<double>(relative.count);
    gates.push_back(gate_of(stats::skewness_gate(relative, critical),
                            " of " + question.subjects[i].estimator->name));
  }
  return gates;
}

/// Checks that the points lie on a power law, by p of the slope that fits best. The gate is red up
/// to max(`level`, 1e-5); `level` is the largest at which a verdict rejects a slope. A red gate
/// leaves no slope: to reject all others neither shows nor refutes a claim. Under a power law it is
/// red with at most this probability.
Gate power_law_gate(const Seen& seen, double level) {
  const double log_p = stats::log_p_of_power_law(points_of(seen));
  const double limit = std::max(least_p_of_fit, level);
  return gate_of("p of a power law", std::exp(log_p), limit,
                 log_p <= std::log(limit) ? "red" : "green");
}

// Standard errors that the fitted constant must exceed: a fainter power law cannot be planned.
constexpr double least_visibility = 3;

/// The variance of b, or of ln b, at size i from one observation.
double point_variance(const TestOutcome& test, std::size_t i, std::size_t channel,
                      const Pilots& pilots) {
  const Question& question = test.question;
  const Moments pilot = pilot_channel(question, i, channel, pilots).moments;
  const double n = question.subjects[i].averaged(test.plan.primaries[i]);
  if (!(pilot.m2 > 0)) return 0;
  if (question.is().of_spread) return 2 + (pilot.kurtosis() - 3) / n;
  return pilot.variance() / n;
}

/// Least-squares C of C M^s at the claimed exponent s, with its standard error.
Constant fit_constant(const Question& question, std::size_t channel, const Pilots& pilots,
                      double exponent) {
  double weight = 0;
  double sum = 0;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const Moments pilot = pilot_channel(question, i, channel, pilots).moments;
    const double shape = std::pow(question.sizes[i], exponent);
    double truth = 0;
    if (question.has_reference_subject) {
      truth = pilot_channel(question, question.compared(), channel, pilots).moments.mean;
    } else if (!question.truths.empty()) {
      truth = question.truths[i][channel].value;
    }
    const double error = pilot.standard_error();
    weight += shape * shape / error / error;
    sum += shape * (pilot.mean - truth) / error / error;
  }
  return {sum / weight, 1 / std::sqrt(weight)};
}

/// Points of one observation each, expected if the claim held with this exponent.
std::optional<SlopeData> expected_points(const TestOutcome& test, std::size_t channel,
                                         const Pilots& pilots, double exponent) {
  const Question& question = test.question;
  const bool logarithms = question.is().of_spread;
  SlopeData data{.scale = logarithms ? stats::SlopeScale::logarithms : stats::SlopeScale::values};
  Constant fit;
  if (!logarithms) {
    fit = fit_constant(question, channel, pilots, question.references[channel].value);
    // NaN, from a point without spread, counts as unseen.
    const bool seen = std::abs(fit.value) >= least_visibility * fit.standard_error;
    if (!seen) return std::nullopt;
  }
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const double size = question.sizes[i];
    const double variance = point_variance(test, i, channel, pilots);
    if (!(variance > 0)) return std::nullopt;
    data.points.push_back(
        {.size = size,
         .estimate = logarithms ? exponent * std::log(size) : fit.value * std::pow(size, exponent),
         .standard_error = std::sqrt(variance)});
  }
  return data;
}

/// theta = s - the claimed exponent, where the quantity goes like (swept parameter)^s.
class SlopeTheta final : public Theta {
 public:
  explicit SlopeTheta(bool of_spread)
      : Theta(
            {.of_spread = of_spread,
             .fit_decides = true,
             .may_be_unbounded = true,
             .absolute = "a slope is an exponent"},
            {{"slope", "fit of a power law: costs over a parameter", of_costs, Keeps::costs, slope},
             {"slope", "fit of a power law: variances over a parameter",
              [](const Question& q) { return q.is().of_spread; }, Keeps::powers, slope},
             {"slope", "fit of a power law: means or biases over a parameter",
              [](const Question& q) { return !of_logarithms(q); }, Keeps::moments, slope}}) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override;

  std::uint64_t choose(TestOutcome& test, const Pilots&) const override {
    const std::uint64_t floor = secondaries_of_floor(test);
    return of_logarithms(test.question) ? std::max(usual_secondaries, floor) : floor;
  }

  /// Size for each subject, from a pilot that shows the claimed power law: its constant at the
  /// claimed exponent exceeds three standard errors. Nullopt if it does not.
  std::optional<std::uint64_t> secondaries_of(const TestOutcome& test, std::size_t channel,
                                              const stats::ErrorRates& rates,
                                              const Pilots& pilots) const override {
    if (of_costs(test.question)) return std::nullopt;
    const double distance = distance_of(test.plan.regions[channel]);
    const double null = test.question.references[channel].value;
    const auto expected = expected_points(test, channel, pilots, null);
    if (!expected) return std::nullopt;
    double most = 0;
    for (const double edge : {null - distance, null + distance}) {
      const auto factor = stats::slope_sample_factor(*expected, edge, rates);
      if (!factor) return impossible_secondaries;
      most = std::max(most, *factor);
    }
    return whole_secondaries(most);
  }

  std::optional<ConstantVerdict> settled(const TestOutcome& test, const Seen& seen) const override {
    const auto verdict = Theta::settled(test, seen);
    // Costs that never vary are exact.
    return !verdict && !of_costs(seen.question) ? invalid(lack_of_spread(seen)) : verdict;
  }

  std::vector<Gate> gates(const TestOutcome& outcome, const Seen& seen, double x) const override {
    std::vector<Gate> gates = skewness_gates(seen, x);
    // A pass rejects theta beyond its margin, a fail elsewhere.
    const auto [alpha, beta] = outcome.share();
    const bool may_exclude = outcome.plan.regions[seen.channel].has_forbidden();
    gates.push_back(power_law_gate(seen, may_exclude ? std::max(alpha, beta) : alpha));
    return gates;
  }

  std::string not_excluded(const ChannelOutcome& channel) const override {
    return !channel.effect.low && !channel.effect.high ? "exponent" : "";
  }
  const char* how_to_exclude() const override {
    return "sweep values where it is larger: 0 has no slope";
  }
};

PreparedEstimator swept(const PreparedEstimator& estimator, const std::string& parameter,
                        const Value& value) {
  PreparedEstimator point = estimator;
  if (parameter == "primaries") {
    point.primaries = value.count("a number of primaries");
  } else {
    point = prepare({.name = estimator.name,
                     .plugin = estimator.entry->information.name,
                     .parameters = with_member(estimator.given, parameter, value),
                     .primaries = estimator.primaries,
                     .where = value.where()},
                    estimator.folder);
  }
  point.name = fmt::format("{} ({} = {})", estimator.listed, parameter, value.text());
  return point;
}

/// Variance and cost of an averaging estimator are those of one primary and do not depend on
/// `primaries`.
void require_slope_of_something(const TestEntry& test, const Subject& subject) {
  const QuantityRow& quantity = *test.claim.left.row;
  const bool of_one = quantity.tested_as_a_ratio;
  if (!of_one || !subject.averages || test.over->parameter != "primaries") return;
  refuse(test.claim.left.where,
         "`{}` is that of one primary of `{}`, which averages: it does not change with "
         "`primaries`, so its slope is 0; sweep another parameter",
         quantity.word, test.claim.left.source.estimator);
}

}  // namespace

Question SlopeTheta::bind(const TestEntry& test, const Estimators& estimators) const {
  const Claim& claim = test.claim;
  if (test.cost == CostKind::seconds) {
    refuse(test.where, "a slope of seconds has no method; count `rays` or `samples`");
  }
  Question question{.test = &test, .theta = this};
  const PreparedEstimator& estimator = estimator_of(claim.left.source, estimators);
  for (const Value& value : test.over->values) {
    auto point =
        std::make_shared<const PreparedEstimator>(swept(estimator, test.over->parameter, value));
    Subject subject = estimates(claim.left.source, *point);
    if (claim.left.row->relative_to_0) {
      question.truths.push_back(truths_of(test, subject, claim.left.source));
    }
    if (claim.left.row->counts_cost) subject.channels = std::vector{subject.channels[0]};
    subject.own = std::move(point);
    question.subjects.push_back(std::move(subject));
    question.sizes.push_back(value.number("a value of `over`"));
  }
  require_slope_of_something(test, question.subjects[0]);
  question.references.assign(question.channel_count(), std::get<Constant>(claim.right));
  add_reference(question, estimators);
  return question;
}

const Theta& theta_of_slopes() { return one<SlopeTheta, false>(); }
const Theta& theta_of_variance_slopes() { return one<SlopeTheta, true>(); }

}  // namespace assay::harness
