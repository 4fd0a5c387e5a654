#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/families/costs.h"
#include "harness/families/evidence_efficiency.h"
#include "harness/families/log_theta.h"
#include "harness/families/lost_to_rounding.h"
#include "harness/families/spread_choice.h"
#include "harness/plan/sample_size.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/group_variance.h"
#include "stats/means/student_t.h"
#include "stats/means/welch_t.h"
#include "stats/variances/cost_ratio.h"
#include "stats/variances/log_efficiency.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::JointMoments;
using stats::Moments;

Interval moved(const Interval& interval, double by) {
  return {interval.low - by, interval.high - by, interval.confidence};
}

/// Evidence on ln(mean x / (factor * mean y)); both means are positive.
Evidence of_means(const Moments& x, const Moments& y, double factor) {
  const double estimate = std::log(x.mean / (y.mean * factor));
  const bool exact = x.m2 == 0 && y.m2 == 0;
  return {.estimate = estimate,
          .at = [=](double t) { return stats::log_cost_ratio(x, y, factor * std::exp(t)); },
          .interval =
              [=](double confidence) {
                if (exact) return Interval{estimate, estimate, confidence};
                return moved(stats::log_cost_ratio_interval(x, y, confidence), std::log(factor));
              },
          .quantity = "",
          .ratio = true,
          .exact = exact};
}

Evidence of_mean(const Moments& x, double null) {
  return {
      .estimate = std::log(x.mean / null),
      .at = [=](double t) { return stats::log_cost(x, null * std::exp(t)); },
      .interval = [=](double confidence) { return stats::log_cost_interval(x, null, confidence); },
      .quantity = "",
      .ratio = true,
      .exact = x.m2 == 0};
}

/// Means per primary, of one subject or two.
Evidence compare_means(const Question& question, std::span<const Moments> means,
                       std::span<const double> divisors) {
  if (!question.of_two()) {
    return of_mean(means[0], question.references[0].value * divisors[0]);
  }
  return of_means(means[0], means[1], question.factor * divisors[0] / divisors[1]);
}

/// Asymptotic, valid from 1000 observations on.
Evidence cost_evidence(const Method&, const Question& question, std::size_t,
                       std::span<const ChannelData> data) {
  std::vector<Moments> costs;
  std::vector<double> divisors;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    costs.push_back(counted_cost(question, data[i]).cost);
    divisors.push_back(question.subjects[i].averaged(data[i].primaries));
  }
  Evidence evidence = compare_means(question, costs, divisors);
  evidence.quantity = question.of_two() ? "ratio of costs" : "cost over the reference";
  return evidence;
}

Evidence efficiency_evidence(const Method&, const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  return evidence_of_efficiency(question, channel, data);
}

Evidence total_variance_evidence(const Method&, const Question& question, std::size_t,
                                 std::span<const ChannelData> data) {
  std::vector<Moments> totals;
  std::vector<double> divisors;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    totals.push_back(data[i].group_variances);
    if (!(totals.back().mean > 0)) {
      throw std::domain_error("no channel of `" + question.subjects[i].estimator->name +
                              "` varies: it has no total variance");
    }
    divisors.push_back(1 / question.subjects[i].averaged(data[i].primaries));
  }
  Evidence evidence = compare_means(question, totals, divisors);
  evidence.quantity =
      question.of_two() ? "ratio of total variances" : "total variance over the reference";
  return evidence;
}

/// ln(seconds per primary) of each replicate; for efficiency -ln(seconds * variance of a primary).
Moments logarithms(const Question& question, std::size_t subject, const ChannelData& data) {
  const double primaries = question.subjects[subject].averaged(data.primaries);
  Moments logs;
  for (const Replicate& replicate : data.replicates) {
    const double seconds = replicate.seconds / static_cast<double>(replicate.count) / primaries;
    if (!question.is().of_spread) {
      logs.add(std::log(seconds));
    } else {
      logs.add(-std::log(seconds * replicate.moments.variance() * primaries));
    }
  }
  if (!std::isfinite(logs.mean)) {
    throw std::domain_error("a replicate took no measurable time or has no spread");
  }
  return logs;
}

double squared_variation(const Moments& x) { return x.variance() / x.mean / x.mean; }

/// Costs and efficiencies in seconds, from replicates: Student's or Welch's t on the logarithms of
/// their costs, or of cost x variance. The mean logarithm is off by about 1 / replicate size, alike
/// on both sides.
Evidence evidence_of_replicates(const Method&, const Question& question, std::size_t channel,
                                std::span<const ChannelData> data) {
  const Moments x = logarithms(question, 0, data[0]);
  const bool cost = !question.is().of_spread;
  if (!question.of_two()) {
    const double null = std::log(question.references[channel].value);
    return {.estimate = x.mean - null,
            .at = [=](double t) { return stats::student_t(x, {.value = null + t}); },
            .interval =
                [=](double confidence) {
                  return stats::student_t_interval(x, {.value = null}, confidence);
                },
            .quantity = cost ? "cost over the reference" : "efficiency over the reference",
            .ratio = true};
  }
  Moments y = logarithms(question, 1, data[1]);
  y.mean += std::log(question.factor);
  return {.estimate = x.mean - y.mean,
          .at = [=](double t) { return stats::welch_t(x, y, {.scale = 1, .offset = t}); },
          .interval = [=](double confidence) { return stats::welch_t_interval(x, y, confidence); },
          .quantity = cost ? "ratio of costs" : "ratio of efficiencies",
          .ratio = true};
}

bool in_seconds(const Question& question) { return question.test->cost == CostKind::seconds; }
bool in_counts(const Question& question) { return !in_seconds(question); }

/// A pilot of single primaries.
struct PilotMoments {
  const Moments& values;
  const std::vector<JointMoments>& with_cost;
};

/// The spread of ln s2 is 2 for a normal law. A mean's excess kurtosis falls like 1 / its size.
double averaged_spread(double of_one, double averaged) { return 2 + (of_one - 2) / averaged; }

/// Theta is the logarithm of a ratio: first over second, or over the claimed number. The spread of
/// a side is the number of observations times the variance of its logarithm. In planning 1 + the
/// spread stands for a kurtosis.
class RatioTheta : public LogTheta {
 public:
  using LogTheta::LogTheta;

  std::optional<PlannedChannel> planned(const Question& question, const Regions& regions,
                                        const Pilots& pilots, const Plan& plan) const override {
    for (const Subject& side : question.subjects) {
      if (side.setup->observations()) return std::nullopt;
    }
    return worst_channel(question, regions, pilots, plan);
  }

  PlannedChannel observed(const Question& question, const Regions& regions, std::size_t channel,
                          std::span<const ChannelData> data) const override {
    const std::optional<double> second =
        question.of_two() ? spread_of(question, 1, channel, data) : std::optional(0.0);
    return {.regions = regions,
            .kurtosis = 1 + spread_of(question, 0, channel, data).value_or(0),
            .other_kurtosis = 1 + second.value_or(0)};
  }

  std::vector<Gate> gates(const TestOutcome& outcome, std::size_t channel,
                          std::span<const ChannelData> data, double x) const override {
    return log_mean_gates(outcome, channel, data, x);
  }

 protected:
  virtual std::optional<double> spread(const Question&, std::size_t subject, std::size_t channel,
                                       std::span<const ChannelData>) const = 0;
  /// The spread of secondaries of `averaged` of the pilot's primaries.
  virtual std::optional<double> predicted_spread(const Question&, const PilotMoments&,
                                                 double averaged) const = 0;

 private:
  std::optional<PlannedChannel> from_pilots(const Question& question, std::size_t channel,
                                            const Pilots& pilots, const Plan& plan) const override {
    return worst_channel(question, plan.regions[channel], pilots, plan);
  }

  std::optional<double> spread_of(const Question& question, std::size_t subject,
                                  std::size_t channel, std::span<const ChannelData> data) const {
    const ChannelData& mine = data[subject];
    if (mine.replicates.empty()) return spread(question, subject, channel, data);
    const double per_count =
        static_cast<double>(mine.moments.count) / static_cast<double>(mine.replicates.size());
    return per_count * logarithms(question, subject, mine).variance();
  }

  /// The largest over the subject's channels: a sum of variances spreads no more than its worst
  /// part.
  std::optional<double> pilot_spread(const Question& question, std::size_t subject,
                                     const Pilots& pilots, const Plan& plan) const {
    const Subject& side = question.subjects[subject];
    const Pilot& pilot = *pilot_of(question, subject, pilots);
    const double averaged = side.averaged(plan.primaries[subject]);
    std::optional<double> most;
    for (const std::size_t channel : side.channels) {
      const PilotMoments seen{.values = pilot.moments(channel),
                              .with_cost = pilot.sums->channels[channel].details().with_cost};
      std::optional<double> spread;
      if (!in_seconds(question)) {
        spread = predicted_spread(question, seen, averaged);
      } else if (seen.values.m2 > 0) {
        spread = averaged_spread(seen.values.kurtosis() - 1, averaged);
      }
      if (spread) most = std::max(most.value_or(0), *spread);
    }
    return most;
  }

  std::optional<PlannedChannel> worst_channel(const Question& question, const Regions& regions,
                                              const Pilots& pilots, const Plan& plan) const {
    if (!all_piloted(question, pilots)) return std::nullopt;
    const auto first = pilot_spread(question, 0, pilots, plan);
    const auto second =
        question.of_two() ? pilot_spread(question, 1, pilots, plan) : std::optional(0.0);
    if (!first || !second || !(*first + *second > 0)) return std::nullopt;
    return PlannedChannel{
        .regions = regions, .kurtosis = 1 + *first, .other_kurtosis = 1 + *second};
  }
};

class CostTheta final : public RatioTheta {
 public:
  CostTheta() : RatioTheta({.joins_channels = true, .rests_on_tails = true}, "costs") {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{{"log-cost", "normal law of the logarithm of a cost",
                                               in_counts, Keeps::costs, cost_evidence},
                                              {"replicates", "t of replicates: costs in seconds",
                                               in_seconds, Keeps::blocks, evidence_of_replicates}};
    return table;
  }
  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question&, std::size_t) const override { return "cost"; }
  std::uint64_t choose(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    return choose_for_costs(question, place, pilots, most, plan);
  }

 protected:
  std::optional<double> spread(const Question& question, std::size_t subject, std::size_t,
                               std::span<const ChannelData> data) const override {
    return squared_variation(by_its_cost(question, data[subject].with_cost).cost);
  }
  std::optional<double> predicted_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged) const override {
    if (pilot.with_cost.empty()) return std::nullopt;
    const JointMoments& sample = by_its_cost(question, pilot.with_cost);
    if (!(sample.cost.mean > 0)) return std::nullopt;
    return squared_variation(sample.cost) / averaged;
  }
};

class EfficiencyTheta final : public RatioTheta {
 public:
  EfficiencyTheta() : RatioTheta({.of_spread = true, .rests_on_tails = true}, "efficiencies") {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"log-efficiency", "normal law of the logarithm of an efficiency", in_counts, Keeps::costs,
         efficiency_evidence},
        {"replicates", "t of replicates: efficiencies in seconds", in_seconds, Keeps::blocks,
         evidence_of_replicates}};
    return table;
  }
  std::uint64_t choose(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    return choose_for_spread(question, place, pilots, most, plan);
  }
  std::string lack_of_numbers(const DrawnTest& test, std::size_t channel,
                              std::span<const ChannelData> data) const override {
    const std::string reason = Theta::lack_of_numbers(test, channel, data);
    return reason.empty() ? lack_of_variance(test.outcome.question, channel, data) : reason;
  }

 protected:
  std::optional<double> spread(const Question& question, std::size_t subject, std::size_t channel,
                               std::span<const ChannelData> data) const override {
    return efficiency_spread(question, subject, channel, data);
  }
  std::optional<double> predicted_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged) const override {
    if (pilot.with_cost.empty()) return std::nullopt;
    const JointMoments& sample = by_its_cost(question, pilot.with_cost);
    if (!(sample.cost.mean > 0) || !(sample.x.m2 > 0)) return std::nullopt;
    // The error's spread about the truth is at most that about the mean, unless bias dominates.
    return averaged_spread(stats::log_efficiency_of(sample).spread, averaged);
  }
};

class TotalVarianceTheta final : public RatioTheta {
 public:
  TotalVarianceTheta()
      : RatioTheta({.joins_channels = true, .of_spread = true, .rests_on_tails = true},
                   "variances") {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"log-total-variance", "normal law of the logarithm of the variances' sum", any_question,
         Keeps::group_variances, total_variance_evidence}};
    return table;
  }
  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question& question, std::size_t channel) const override {
    return question.subjects[0].channels.size() > 1 ? "all channels"
                                                    : Theta::channel_name(question, channel);
  }
  std::uint64_t choose(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    return choose_for_spread(question, place, pilots, most, plan);
  }
  std::string lack_of_numbers(const DrawnTest& test, std::size_t channel,
                              std::span<const ChannelData> data) const override {
    const Question& question = test.outcome.question;
    std::string reason = Theta::lack_of_numbers(test, channel, data);
    for (std::size_t i = 0; i < question.compared() && reason.empty(); ++i) {
      std::vector<Moments> channels;
      for (const std::size_t each : question.subjects[i].channels) {
        channels.push_back(test.samples[i].summary().moments(each));
      }
      reason = variances_lost_to_rounding(question.subjects[i], test.outcome.plan.primaries[i],
                                          channels);
    }
    return reason;
  }

 protected:
  std::optional<double> spread(const Question&, std::size_t subject, std::size_t,
                               std::span<const ChannelData> data) const override {
    return static_cast<double>(variance_group) * squared_variation(data[subject].group_variances);
  }
  std::optional<double> predicted_spread(const Question&, const PilotMoments& pilot,
                                         double averaged) const override {
    if (!(pilot.values.m2 > 0)) return std::nullopt;
    return averaged_spread(pilot.values.kurtosis() - 1, averaged);
  }
};

const CostTheta cost_theta;
const EfficiencyTheta efficiency_theta;
const TotalVarianceTheta total_variance_theta;

bool is_biased(const Subject& subject) {
  return subject.estimator->nature().bias.value_or(BiasClass::unbiased) != BiasClass::unbiased;
}

/// The mean squared error of an averaging estimator depends on `primaries`, so the suite must say
/// it.
void require_primaries(const Subject& subject) {
  if (!subject.averages || subject.estimator->primaries) return;
  throw InputError(subject.estimator->where,
                   fmt::format("the mean squared error of `{}` depends on how many primaries it "
                               "averages: give it `primaries`",
                               subject.estimator->name));
}

}  // namespace

Question bind_cost(const TestEntry& test, const Estimators& estimators) {
  Question question = one_or_two(test, cost_theta, estimators);
  require_drawn(question);
  return question;
}

Question bind_efficiency(const TestEntry& test, const Estimators& estimators) {
  Question question = one_or_two(test, efficiency_theta, estimators);
  require_drawn(question);
  const bool asked = test.reference || test.reference_number;
  const std::vector<Source> sources = sources_of(test.claim);
  question.truths.resize(question.subjects.size());
  bool any = false;
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& subject = question.subjects[i];
    if (!asked && !is_biased(subject)) continue;
    require_primaries(subject);
    any = true;
    question.truths[i] = test.reference ? std::vector<Constant>(subject.channels.size())
                                        : truths_of(test, subject, sources[i]);
  }
  if (any && test.cost == CostKind::seconds) {
    throw InputError(test.where,
                     "a mean squared error per second has no method; count `rays` or `samples`");
  }
  add_reference(question, estimators);
  return question;
}

Question bind_total_variance(const TestEntry& test, const Estimators& estimators) {
  return one_or_two(test, total_variance_theta, estimators);
}

const Theta& theta_of_costs() { return cost_theta; }
const Theta& theta_of_efficiencies() { return efficiency_theta; }
const Theta& theta_of_total_variances() { return total_variance_theta; }

}  // namespace assay::harness
