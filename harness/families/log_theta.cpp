#include "harness/families/log_theta.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "harness/plan/sizes.h"
#include "harness/run/evaluate.h"
#include "harness/theta/constant.h"
#include "harness/theta/evidence.h"
#include "stats/gates/assumption_gates.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

using stats::Influence;
using stats::Interval;
using stats::TestResult;

// ---- Evidence

/// Theta is ln(first / second / null), or ln(first / null), or minus that.
struct LogRatio {
  std::vector<RatioSide> sides;
  double log_null = 0;
  double sign = 1;  ///< -1 if the sides are inverses of the quantities.

  bool uncertain() const {
    return std::ranges::any_of(
        sides, [](const RatioSide& side) { return side.truth.known.standard_error > 0; });
  }
  /// True if one truth, with one error, serves both sides.
  bool shares_truth() const {
    const auto known = [&](std::size_t i) {
      return std::pair(sides[i].truth.known.value, sides[i].truth.known.standard_error);
    };
    return sides.size() == 2 && known(0) == known(1);
  }
};

TestResult test(const LogRatio& ratio, std::span<const Influence> sides, double theta) {
  const double log_ratio = ratio.sign * (theta + ratio.log_null);
  TestResult result = sides.size() == 1 ? stats::influence_t(sides[0], log_ratio)
                                        : stats::influence_t(sides[0], sides[1], log_ratio);
  if (ratio.sign > 0) return result;
  result.statistic = -result.statistic;
  std::swap(result.log_p_lower, result.log_p_upper);
  return result;
}

TestResult over_truths(const LogRatio& ratio, TestResult as_known, double theta) {
  std::vector<stats::UncertainReference> references;
  for (const RatioSide& side : ratio.sides) references.push_back(side.truth);
  const bool shared = ratio.shares_truth();
  if (shared) references.resize(1);
  const auto at = [&](std::span<const double> truths) {
    std::vector<Influence> sides;
    for (std::size_t i = 0; i < ratio.sides.size(); ++i) {
      sides.push_back(ratio.sides[i].influence(truths[shared ? 0 : i]));
    }
    return test(ratio, sides, theta);
  };
  as_known.log_p_lower = stats::log_p_over_references(
      [&](std::span<const double> truths) { return at(truths).log_p_lower; }, references);
  as_known.log_p_upper = stats::log_p_over_references(
      [&](std::span<const double> truths) { return at(truths).log_p_upper; }, references);
  return as_known;
}

// ---- Plans

// Fewer observations do not show how heavy the tail of their squares is.
constexpr std::uint64_t fewest_for_a_variance = usual_secondaries;

bool varies(const PlannedChannel& channel) {
  return channel.standard_deviation > 0 || channel.other_deviation > 0;
}

/// Chi-square and F take flatter data for normal ones and find as little as in those.
double deviation_for(const Method& method, double deviation) {
  return method.is.of_normal_values && deviation > 0 ? std::max(std::numbers::sqrt2, deviation)
                                                     : deviation;
}

/// One mean as uncertain as theta, of as many observations as the smaller side.
struct PlannedMean {
  stats::MeanPlan plan;
  double count;
};
PlannedMean mean_plan(const Method& method, const stats::ErrorRates& rates,
                      const PlannedChannel& channel, const stats::SampleSizes& sizes) {
  const double n = std::min(sizes.x, sizes.y);
  const double x = deviation_for(method, channel.standard_deviation) * std::sqrt(n / sizes.x);
  const double y = deviation_for(method, channel.other_deviation) * std::sqrt(n / sizes.y);
  return {.plan = {.standard_deviation = std::hypot(x, y),
                   .allow = channel.regions.allow,
                   .rates = rates},
          .count = n};
}

}  // namespace

RatioSide without_truth(const stats::Influence& influence) {
  return {.influence = [influence](double) { return influence; }};
}

Evidence by_influence(const Method&, const Question& question, std::size_t channel,
                      std::span<const ChannelData> data) {
  const auto& family = dynamic_cast<const LogTheta&>(*question.theta);
  LogRatio ratio{.log_null = family.log_null(question, channel, data),
                 .sign = family.is_inverse() ? -1.0 : 1.0};
  std::vector<Influence> known;
  double variance = 0;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    ratio.sides.push_back(family.side(question, i, channel, data));
    known.push_back(ratio.sides[i].influence(ratio.sides[i].truth.known.value));
    variance += std::pow(known.back().relative.standard_error(), 2);
  }
  const double second = known.size() == 1 ? 0 : known[1].log_value;
  const double estimate = ratio.sign * (known[0].log_value - second) - ratio.log_null;
  const auto at = [=](double theta) {
    const TestResult as_known = test(ratio, known, theta);
    return ratio.uncertain() ? over_truths(ratio, as_known, theta) : as_known;
  };
  const double error = std::sqrt(variance);
  const auto interval = [=](double confidence) {
    if (error == 0) return Interval{estimate, estimate, confidence};
    return interval_by_inversion(at, {.estimate = estimate, .step = error}, confidence);
  };
  return {.estimate = estimate,
          .at = at,
          .interval = interval,
          .quantity = quantity_of(question),
          .ratio = true,
          .exact = error == 0};
}

std::string quantity_of(const Question& question) {
  const RatioWords& words = dynamic_cast<const LogTheta&>(*question.theta).words_;
  return question.of_two() ? fmt::format("ratio of {}", words.many)
                           : fmt::format("{} over the reference", words.one);
}

double averaged_spread(double of_one, double averaged) { return 2 + (of_one - 2) / averaged; }

MethodRow influence_row(bool (*answers)(const Question&), Keeps keeps) {
  return {"influence-t",
          "Student's t of influence values with Hall's correction: variances, costs, efficiencies",
          answers,
          keeps,
          by_influence,
          {.over_looks = stats::LookLaw::independent_increments}};
}

void LogTheta::check_margin(const Question& question, const Margin& margin) const {
  Theta::check_margin(question, margin);
  if (margin.relative || !question.of_two()) return;
  throw InputError(
      margin.where,
      fmt::format("a margin on a ratio of {} is relative; give it in per cent", words_.many));
}

std::optional<ThetaError> LogTheta::error(const Question& question, std::size_t channel,
                                          std::span<const ChannelData> data) const {
  ThetaError error;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const std::optional<double> spread = this->spread(question, i, channel, data);
    if (!spread) return std::nullopt;
    double& part = question.subjects[i].setup->observations() ? error.fixed : error.drawn;
    const double count = static_cast<double>(data[i].moments.count);
    part = std::hypot(part, std::sqrt(*spread / count));
    // A drawn reference is new in every run.
    double& of_truth = question.has_reference_subject ? error.drawn : error.fixed;
    of_truth = std::hypot(of_truth, std::sqrt(spread_of_truth(question, i, channel, data) / count));
  }
  if (!question.references.empty()) {
    error.fixed = std::hypot(error.fixed, question.references[channel].standard_error);
  }
  return error;
}

std::uint64_t LogTheta::choose(const Question& question, const FamilyPlace&, const Pilots&,
                               std::uint64_t, Plan& plan) const {
  return std::max(usual_secondaries, secondaries_of_floor(question, plan));
}

std::optional<std::uint64_t> LogTheta::secondaries(const Question& question,
                                                   const ErrorShare& share, const Pilots& pilots,
                                                   const Plan& plan) const {
  if (!all_piloted(question, pilots)) return std::nullopt;
  return most_of_channels(question, [&](std::size_t i) -> std::optional<std::uint64_t> {
    const Regions& regions = plan.regions[i];
    const auto channel = from_pilots(question, i, regions, pilots, plan);
    if (!channel || !regions.detect) return std::nullopt;
    const PlannedMean mean = mean_plan(plan.method, planned_rates(share, regions), *channel, {});
    return stats::student_t_sample_size(mean.plan, *regions.detect)
        .value_or(impossible_secondaries);
  });
}

std::optional<PlannedChannel> LogTheta::planned(const Question& question, const Regions& regions,
                                                const Pilots& pilots, const Plan& plan) const {
  for (const Subject& side : question.subjects) {
    if (side.setup->observations()) return std::nullopt;
  }
  return from_pilots(question, std::nullopt, regions, pilots, plan);
}

PlannedChannel LogTheta::observed(const Question& question, const Regions& regions,
                                  std::size_t channel, std::span<const ChannelData> data) const {
  PlannedChannel observed{.regions = regions};
  for (std::size_t i = 0; i < question.compared(); ++i) {
    double& deviation = i == 0 ? observed.standard_deviation : observed.other_deviation;
    deviation = std::sqrt(spread(question, i, channel, data).value_or(0) +
                          spread_of_truth(question, i, channel, data));
  }
  return observed;
}

std::optional<double> LogTheta::detectable(const Question& question, const TestSize& size,
                                           const Plan& plan, const PlannedChannel& channel) const {
  if (!varies(channel)) return std::nullopt;
  const PlannedMean mean = mean_plan(plan.method, planned_rates(size.share, channel.regions),
                                     channel, sizes_of(question, size.secondaries));
  return stats::student_t_detectable(mean.plan, mean.count);
}

std::optional<double> LogTheta::power(const Question& question, const TestSize& size,
                                      const Plan& plan, const PlannedChannel& channel,
                                      double effect) const {
  if (!varies(channel)) return std::nullopt;
  const bool within = channel.regions.within();
  const PlannedMean mean = mean_plan(plan.method, planned_rates(size.share, channel.regions),
                                     channel, sizes_of(question, size.secondaries));
  const double one_margin =
      stats::student_t_power(mean.plan, mean.count, within ? *channel.regions.detect : effect);
  return within ? std::max(0.0, 2 * one_margin - 1) : one_margin;
}

std::string LogTheta::lack_of_numbers(const DrawnTest& test, std::size_t channel,
                                      std::span<const ChannelData> data) const {
  const std::string reason = Theta::lack_of_numbers(test, channel, data);
  const bool of_one_variance = is.of_spread && !is.joins_channels;
  return reason.empty() && of_one_variance ? lack_of_variance(test.outcome.question, channel, data)
                                           : reason;
}

std::vector<Gate> LogTheta::gates(const TestOutcome& outcome, std::size_t channel,
                                  std::span<const ChannelData> data, double critical) const {
  const Question& question = outcome.question;
  std::vector<Gate> gates;
  if (outcome.plan.method.keeps == Keeps::blocks) return gates;
  const std::string name = channel_suffix(question, channel);
  std::vector<Influence> sides;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const std::string mine = name + " of " + question.subjects[i].estimator->name;
    const std::uint64_t count = data[i].moments.count;
    if (is.of_spread && count < fewest_for_a_variance) {
      gates.push_back(gate_of(reports::Gate{.name = "observations of a variance",
                                            .value = static_cast<double>(count),
                                            .limit = static_cast<double>(fewest_for_a_variance),
                                            .state = "red"},
                              mine));
    }
    const std::optional<Influence> influence = this->influence(question, i, channel, data);
    if (!influence) return gates;
    sides.push_back(*influence);
    if (influence->relative.m2 > 0) {
      gates.push_back(gate_of(stats::dominance_gate(influence->relative), mine));
    }
  }
  const auto& x = sides[0].relative;
  if (sides.size() == 1 && x.m2 > 0) {
    gates.push_back(gate_of(stats::residual_skewness_gate(x, {.value = 1}, critical), name));
  } else if (sides.size() == 2 && x.m2 + sides[1].relative.m2 > 0) {
    gates.push_back(
        gate_of(stats::residual_skewness_gate(x, sides[1].relative, 1, critical), name));
  }
  return gates;
}

std::optional<double> LogTheta::spread(const Question& question, std::size_t subject,
                                       std::size_t channel,
                                       std::span<const ChannelData> data) const {
  const std::optional<Influence> influence = this->influence(question, subject, channel, data);
  if (!influence) return std::nullopt;
  const double error = influence->relative.standard_error();
  return static_cast<double>(data[subject].moments.count) * error * error;
}

double LogTheta::log_null(const Question& question, std::size_t channel,
                          std::span<const ChannelData>) const {
  return std::log(question.of_two() ? question.factor : question.references[channel].value);
}

std::optional<Influence> LogTheta::influence(const Question& question, std::size_t subject,
                                             std::size_t channel,
                                             std::span<const ChannelData> data) const {
  if (!tells(data[subject])) return std::nullopt;
  const RatioSide side = this->side(question, subject, channel, data);
  return side.influence(side.truth.known.value);
}

std::optional<double> LogTheta::predicted_spread(const Question&, const PilotMoments& pilot,
                                                 double averaged) const {
  if (!(pilot.values.m2 > 0)) return std::nullopt;
  return averaged_spread(pilot.values.kurtosis() - 1, averaged);
}

std::optional<double> LogTheta::pilot_spread(const Question& question, std::size_t subject,
                                             std::optional<std::size_t> channel,
                                             const Pilots& pilots, const Plan& plan) const {
  const Subject& side = question.subjects[subject];
  const Pilot& pilot = *pilot_of(side, pilots);
  const double averaged = side.averaged(plan.primaries[subject]);
  std::optional<double> most;
  for (std::size_t i = 0; i < side.channels.size(); ++i) {
    if (channel && !is.joins_channels && i != *channel) continue;
    const std::size_t index = side.channels[i];
    const stats::Moments values = pilot.moments(index);
    const PilotMoments seen{.values = values, .joint = joint_moments(pilot.sums->details(index))};
    const auto spread = predicted_spread(question, seen, averaged);
    if (spread) most = std::max(most.value_or(0), *spread);
  }
  return most;
}

std::optional<PlannedChannel> LogTheta::from_pilots(const Question& question,
                                                    std::optional<std::size_t> channel,
                                                    const Regions& regions, const Pilots& pilots,
                                                    const Plan& plan) const {
  if (!all_piloted(question, pilots)) return std::nullopt;
  PlannedChannel planned{.regions = regions};
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const std::optional<double> spread = pilot_spread(question, i, channel, pilots, plan);
    if (!spread) return std::nullopt;
    (i == 0 ? planned.standard_deviation : planned.other_deviation) = std::sqrt(*spread);
  }
  if (!varies(planned)) return std::nullopt;
  return planned;
}

using stats::JointMoments;
using stats::Moments;

const JointMoments& by_its_cost(const Question& question, std::span<const JointMoments> joint) {
  return joint[question.test->cost == CostKind::samples ? samples_cost : rays_cost];
}

const JointMoments& counted_cost(const Question& question, const ChannelData& data) {
  const JointMoments& sample = by_its_cost(question, data.joint);
  if (sample.of_cost.mean > 0) return sample;
  throw std::domain_error(
      "no cost was counted: an estimator that traces no rays counts its `samples`; say "
      "`cost: samples`");
}

JointMoments powers_of_values(const ChannelData& data) {
  return data.joint.empty() ? stats::joint_of_four(data.moments) : data.joint.front();
}

Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data) {
  if (!question.has_reference_subject) return question.truths[subject][channel];
  const Moments& reference = data.back().moments;
  return {reference.mean, reference.standard_error()};
}

}  // namespace assay::harness
