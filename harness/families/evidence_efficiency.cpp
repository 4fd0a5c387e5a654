#include "harness/families/evidence_efficiency.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "harness/families/costs.h"
#include "harness/theta/inversion.h"
#include "stats/means/uncertain_reference.h"
#include "stats/variances/log_efficiency.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::LogEfficiency;
using stats::TestResult;
using stats::UncertainReference;

// Confidence of one standard error to either side.
constexpr double narrow_confidence = 0.6827;

/// A side of the claim. With a truth, its mean squared error stands for the variance.
struct MeasuredSide {
  stats::JointMoments sample;
  std::optional<Constant> truth = {};

  LogEfficiency at(double value) const {
    return truth ? stats::log_efficiency_of(sample, value) : stats::log_efficiency_of(sample);
  }
  LogEfficiency as_known() const { return at(truth ? truth->value : 0); }
  UncertainReference reference() const {
    if (!truth) return {};
    return {.known = {truth->value, truth->standard_error}, .turn = sample.x.mean};
  }
};

MeasuredSide side_of(const Question& question, std::size_t subject, std::size_t channel,
                     std::span<const ChannelData> data) {
  MeasuredSide side{.sample = counted_cost(question, data[subject])};
  if (!question.truths[subject].empty()) side.truth = truth_of(question, subject, channel, data);
  return side;
}

bool have_one_truth(const MeasuredSide& x, const MeasuredSide& y) {
  return x.truth && y.truth && x.truth->value == y.truth->value &&
         x.truth->standard_error == y.truth->standard_error;
}

/// Efficiencies to compare, as functions of the truths.
struct Efficiencies {
  std::vector<UncertainReference> references;
  std::function<TestResult(std::span<const double> truths, double theta)> test;
  std::function<Interval(double confidence)> interval_as_known;
  double estimate = 0;
};

TestResult over_references(const Efficiencies& asked, double theta) {
  std::vector<double> known;
  for (const UncertainReference& reference : asked.references) {
    known.push_back(reference.known.value);
  }
  TestResult result = asked.test(known, theta);
  result.log_p_lower = stats::log_p_over_references(
      [&](auto truths) { return asked.test(truths, theta).log_p_lower; }, asked.references);
  result.log_p_upper = stats::log_p_over_references(
      [&](auto truths) { return asked.test(truths, theta).log_p_upper; }, asked.references);
  return result;
}

Evidence evidence(const Efficiencies& asked, const char* quantity) {
  const auto at = [asked](double theta) { return over_references(asked, theta); };
  const bool exact = std::ranges::all_of(asked.references,
                                         [](const auto& r) { return r.known.standard_error == 0; });
  const auto interval = [asked, at, exact](double confidence) {
    if (exact) return asked.interval_as_known(confidence);
    const Interval narrow = asked.interval_as_known(narrow_confidence);
    return interval_by_inversion(
        at, {.estimate = asked.estimate, .step = (narrow.high - narrow.low) / 2}, confidence);
  };
  return {.estimate = asked.estimate,
          .at = at,
          .interval = interval,
          .quantity = quantity,
          .ratio = true};
}

Evidence of_one(const MeasuredSide& x, double null) {
  const LogEfficiency known = x.as_known();
  return evidence({.references = {x.reference()},
                   .test =
                       [=](std::span<const double> truths, double theta) {
                         return stats::log_efficiency(x.at(truths[0]), null * std::exp(theta));
                       },
                   .interval_as_known =
                       [=](double confidence) {
                         return stats::log_efficiency_interval(known, null, confidence);
                       },
                   .estimate = known.value - std::log(null)},
                  "efficiency over the reference");
}

Evidence of_two(const MeasuredSide& x, const MeasuredSide& y, double factor) {
  const LogEfficiency one = x.as_known();
  const LogEfficiency other = y.as_known();
  std::vector<UncertainReference> references{x.reference()};
  if (!have_one_truth(x, y)) references.push_back(y.reference());
  return evidence(
      {.references = references,
       .test =
           [=](std::span<const double> truths, double theta) {
             return stats::log_efficiency_ratio(x.at(truths.front()), y.at(truths.back()),
                                                factor * std::exp(theta));
           },
       .interval_as_known = [=](double confidence) -> Interval {
         const Interval ratio = stats::log_efficiency_ratio_interval(one, other, confidence);
         return {ratio.low - std::log(factor), ratio.high - std::log(factor), confidence};
       },
       .estimate = one.value - other.value - std::log(factor)},
      "ratio of efficiencies");
}

}  // namespace

Evidence evidence_of_efficiency(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data) {
  const MeasuredSide x = side_of(question, 0, channel, data);
  if (!question.of_two()) return of_one(x, question.references[channel].value);
  return of_two(x, side_of(question, 1, channel, data), question.factor);
}

double efficiency_spread(const Question& question, std::size_t subject, std::size_t channel,
                         std::span<const ChannelData> data) {
  const MeasuredSide side = side_of(question, subject, channel, data);
  const LogEfficiency known = side.as_known();
  if (!side.truth) return known.spread;
  const stats::Moments& x = side.sample.x;
  const double error = side.truth->standard_error;
  const double bias = x.mean_less(side.truth->value);
  const double squared = x.m2 / known.count + bias * bias;
  const double of_truth = error * std::sqrt(4 * bias * bias + 2 * error * error) / squared;
  return known.spread + known.count * of_truth * of_truth;
}

}  // namespace assay::harness
