#include "stats/variances/slope.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/families/costs.h"
#include "harness/families/evidence_slope.h"
#include "harness/families/families.h"
#include "harness/plan/critical.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/planned_rates.h"
#include "harness/plan/sample_size.h"
#include "harness/plan/secondaries.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"

namespace assay::harness {
namespace {

// ---- Sizes

// Standard errors that the fitted constant must exceed: a fainter power law cannot be planned.
constexpr double least_visibility = 3;

stats::Moments moments_of(const Question& question, std::size_t subject, std::size_t channel,
                          const Pilots& pilots) {
  return pilot_channel(question, subject, channel, pilots).moments;
}

/// The variance of b, or of ln b, at size i from one observation.
double point_variance(const Question& question, std::size_t i, std::size_t channel,
                      const Pilots& pilots, const Plan& plan) {
  const stats::Moments& pilot = moments_of(question, i, channel, pilots);
  const double n = question.subjects[i].averaged(plan.primaries[i]);
  if (!(pilot.m2 > 0)) return 0;
  if (question.is().of_spread) {
    return 2 + (pilot.kurtosis() - 3) / n;
  }
  return pilot.variance() / n;
}

/// Least-squares C of C M^s at the claimed exponent s, with its standard error.
struct Fit {
  double constant;
  double standard_error;
};

Fit fit_constant(const Question& question, std::size_t channel, const Pilots& pilots,
                 double exponent) {
  double weight = 0;
  double sum = 0;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const stats::Moments& pilot = moments_of(question, i, channel, pilots);
    const double shape = std::pow(question.sizes[i], exponent);
    double truth = 0;
    if (question.has_reference_subject) {
      truth = moments_of(question, question.compared(), channel, pilots).mean;
    } else if (!question.truths.empty()) {
      truth = question.truths[i][channel].value;
    }
    const double error = pilot.standard_error();
    weight += shape * shape / error / error;
    sum += shape * (pilot.mean - truth) / error / error;
  }
  return {.constant = sum / weight, .standard_error = 1 / std::sqrt(weight)};
}

/// Points of one observation each, expected if the claim held with this exponent.
std::optional<stats::SlopeData> expected_points(const Question& question, std::size_t channel,
                                                const Pilots& pilots, const Plan& plan,
                                                double exponent) {
  const bool logarithms = question.is().of_spread;
  stats::SlopeData data{.scale =
                            logarithms ? stats::SlopeScale::logarithms : stats::SlopeScale::values};
  Fit fit{.constant = 1, .standard_error = 0};
  if (!logarithms) {
    fit = fit_constant(question, channel, pilots, question.references[channel].value);
    // NaN, from a point without spread, counts as unseen.
    const bool seen = std::abs(fit.constant) >= least_visibility * fit.standard_error;
    if (!seen) return std::nullopt;
  }
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const double size = question.sizes[i];
    const double variance = point_variance(question, i, channel, pilots, plan);
    if (!(variance > 0)) return std::nullopt;
    data.points.push_back({.size = size,
                           .estimate = logarithms ? exponent * std::log(size)
                                                  : fit.constant * std::pow(size, exponent),
                           .standard_error = std::sqrt(variance)});
  }
  return data;
}

std::optional<std::uint64_t> slope_channel(const Question& question, std::size_t channel,
                                           const ErrorShare& share, const Pilots& pilots,
                                           const Plan& plan) {
  const Regions& regions = plan.regions[channel];
  const double distance = distance_of(regions);
  if (!(distance > 0)) return std::nullopt;
  const double null = question.references[channel].value;
  const stats::ErrorRates rates = planned_rates(share, regions);
  const auto expected = expected_points(question, channel, pilots, plan, null);
  if (!expected) return std::nullopt;
  double most = 0;
  for (const double edge : {null - distance, null + distance}) {
    const auto factor = stats::slope_sample_factor(
        *expected, edge,
        {.alpha = rates.two_sided ? rates.alpha / 2 : rates.alpha, .beta = rates.beta});
    if (!factor) return impossible_secondaries;
    most = std::max(most, *factor);
  }
  const double count = std::ceil(most);
  return whole_secondaries(count);
}

/// The level at which the verdict rejects theta: a pass beyond its margin, a fail elsewhere.
double largest_level(const ErrorShare& share, const Regions& regions) {
  return regions.has_forbidden() ? std::max(share.alpha, share.beta) : share.alpha;
}

Evidence slope(const Method&, const Question& question, std::size_t channel,
               std::span<const ChannelData> data) {
  return evidence_of_slope(question, channel, data);
}

/// theta = s - the claimed exponent, where the quantity goes like (swept parameter)^s.
class SlopeTheta final : public Theta {
 public:
  using Theta::Theta;

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"slope", "weighted fit of a power law: costs over a parameter", of_costs, Keeps::costs,
         slope},
        {"slope", "weighted fit of a power law: variances over a parameter",
         [](const Question& q) { return q.is().of_spread; }, Keeps::powers, slope},
        {"slope", "weighted fit of a power law: means or biases over a parameter",
         [](const Question& q) { return !of_costs(q) && !q.is().of_spread; }, Keeps::moments,
         slope}};
    return table;
  }

  void check_margin(const Question&, const Margin& margin) const override {
    require_absolute(margin, "a slope is an exponent");
  }
  std::optional<double> known_size(const Question&) const override { return std::nullopt; }

  std::uint64_t choose(const Question& question, const FamilyPlace&, const Pilots&, std::uint64_t,
                       Plan& plan) const override {
    const std::uint64_t floor = secondaries_of_floor(question, plan);
    return is.of_spread || of_costs(question) ? std::max(usual_secondaries, floor) : floor;
  }

  /// Size for each subject, from a pilot that shows the claimed power law: its constant at the
  /// claimed exponent exceeds three standard errors. Nullopt if it does not.
  std::optional<std::uint64_t> secondaries(const Question& question, const ErrorShare& share,
                                           const Pilots& pilots, const Plan& plan) const override {
    if (!all_piloted(question, pilots) || of_costs(question)) return std::nullopt;
    return most_over_channels(question, [&](std::size_t channel) {
      return slope_channel(question, channel, share, pilots, plan);
    });
  }

  std::string lack_of_numbers(const DrawnTest& test, std::size_t channel,
                              std::span<const ChannelData> data) const override {
    const std::string reason = Theta::lack_of_numbers(test, channel, data);
    return reason.empty() ? point_without_spread(test.outcome.question, channel, data) : reason;
  }

  std::vector<Gate> gates(const TestOutcome& outcome, std::size_t channel,
                          std::span<const ChannelData> data, double x) const override {
    std::vector<Gate> gates = skewness_gates(outcome.question, channel, data, x);
    gates.push_back(power_law_gate(outcome.question, channel, data,
                                   largest_level(outcome.share(), outcome.plan.regions[channel])));
    return gates;
  }

  std::string not_excluded(const ChannelOutcome& channel) const override {
    const bool no_low = !channel.effect.low || !std::isfinite(*channel.effect.low);
    const bool no_high = !channel.effect.high || !std::isfinite(*channel.effect.high);
    return no_low && no_high ? "exponent" : "";
  }
};

const SlopeTheta slope_theta({.fit_decides = true});
const SlopeTheta variance_slope_theta({.of_spread = true, .fit_decides = true});

// ---- Binding

Value with(const Value& parameters, const std::string& name, const Value& value) {
  std::vector<Value::Member> members;
  for (const Value::Member& member : parameters.members()) {
    if (member.first != name) members.push_back(member);
  }
  members.emplace_back(name, value);
  return Value::map(std::move(members), parameters.where());
}

/// The estimator at one value of the sweep.
PreparedEstimator swept(const PreparedEstimator& estimator, const std::string& parameter,
                        const Value& value) {
  PreparedEstimator point = estimator;
  if (parameter == "primaries") {
    point.primaries = value.count("a number of primaries");
  } else {
    point = prepare({.name = estimator.name,
                     .plugin = estimator.entry->information.name,
                     .parameters = with(estimator.given, parameter, value),
                     .primaries = estimator.primaries,
                     .where = value.where()},
                    estimator.folder);
  }
  point.name = fmt::format("{} ({} = {})", estimator.listed, parameter, value.text());
  return point;
}

/// InputError, with the quantities that have a slope.
void require_slope(const Claim& claim) {
  if (claim.left.row->slope != nullptr) return;
  std::vector<std::string> words;
  for (const QuantityRow& row : quantities()) {
    if (row.slope != nullptr) words.push_back(row.word);
  }
  const std::string last = words.back();
  words.pop_back();
  throw InputError(claim.left.where,
                   fmt::format("`slope` takes a {} or {}, not `{}`", fmt::join(words, ", "), last,
                               claim.left.row->word));
}

void require_counted(const TestEntry& test) {
  if (test.cost != CostKind::seconds) return;
  throw InputError(test.where, "a slope of seconds has no method; count `rays` or `samples`");
}

/// Variance and cost of an averaging estimator are those of one primary and do not depend on
/// `primaries`.
void require_slope_of_something(const TestEntry& test, const Subject& subject) {
  const QuantityRow& quantity = *test.claim.left.row;
  const bool of_one = quantity.tested_as_a_ratio;
  if (!of_one || !subject.averages || test.over->parameter != "primaries") return;
  throw InputError(test.claim.left.where,
                   fmt::format("`{}` is that of one primary of `{}`, which averages: it does not "
                               "change with `primaries`, and its slope is 0; sweep a parameter",
                               quantity.word, test.claim.left.source.estimator));
}

}  // namespace

Question bind_slope(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  require_slope(claim);
  require_counted(test);
  Question question{.test = &test, .theta = claim.left.row->slope, .subjects = {}};
  const PreparedEstimator& estimator = estimator_of(claim.left.source, estimators);
  for (const Value& value : test.over->values) {
    auto point =
        std::make_shared<const PreparedEstimator>(swept(estimator, test.over->parameter, value));
    Subject subject = estimates(claim.left.source, *point);
    if (claim.left.row->relative_to_0) {
      question.truths.push_back(test.reference ? std::vector<Constant>(subject.channels.size())
                                               : truths_of(test, subject, claim.left.source));
    }
    if (claim.left.row->counts_cost) subject.channels.resize(1);
    subject.own = std::move(point);
    question.subjects.push_back(std::move(subject));
    question.sizes.push_back(value.number("a value of `over`"));
  }
  const Constant number = std::get<Constant>(claim.right);
  if (number.standard_error > 0) {
    throw InputError(claim.left.where,
                     "a slope is tested against an exact number: `+-` has no method here");
  }
  require_slope_of_something(test, question.subjects[0]);
  question.references.assign(question.channel_count(), number);
  add_reference(question, estimators);
  return question;
}

const Theta& theta_of_slopes() { return slope_theta; }
const Theta& theta_of_variance_slopes() { return variance_slope_theta; }

}  // namespace assay::harness
