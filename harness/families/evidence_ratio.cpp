#include "harness/families/evidence_ratio.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/families/evidence_efficiency.h"
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
using stats::TestResult;

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

Evidence cost_evidence(const Question& question, std::span<const ChannelData> data) {
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

Evidence total_variance_evidence(const Question& question, std::span<const ChannelData> data) {
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
    if (question.kind == QuestionKind::cost) {
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

}  // namespace

const JointMoments& by_its_cost(const Question& question, std::span<const JointMoments> with_cost) {
  return with_cost[question.test->cost == CostKind::samples ? samples_cost : rays_cost];
}

const JointMoments& counted_cost(const Question& question, const ChannelData& data) {
  const JointMoments& sample = by_its_cost(question, data.with_cost);
  if (sample.cost.mean > 0) return sample;
  throw std::domain_error(
      "no cost was counted: an estimator that traces no rays counts its `samples`; say "
      "`cost: samples`");
}

Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data) {
  if (!question.has_reference_subject) return question.truths[subject][channel];
  const Moments& reference = data.back().moments;
  return {reference.mean, reference.standard_error()};
}

Evidence evidence_of_ratio(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data) {
  if (question.kind == QuestionKind::cost) return cost_evidence(question, data);
  if (question.kind == QuestionKind::efficiency) {
    return evidence_of_efficiency(question, channel, data);
  }
  return total_variance_evidence(question, data);
}

Evidence evidence_of_replicates(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data) {
  const Moments x = logarithms(question, 0, data[0]);
  const bool cost = question.kind == QuestionKind::cost;
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

std::optional<double> log_spread(const Question& question, std::size_t subject, std::size_t channel,
                                 std::span<const ChannelData> data) {
  const ChannelData& mine = data[subject];
  if (!mine.replicates.empty()) {
    const double per_count =
        static_cast<double>(mine.moments.count) / static_cast<double>(mine.replicates.size());
    return per_count * logarithms(question, subject, mine).variance();
  }
  if (question.kind == QuestionKind::cost) {
    return squared_variation(by_its_cost(question, mine.with_cost).cost);
  }
  if (question.kind == QuestionKind::efficiency) {
    return efficiency_spread(question, subject, channel, data);
  }
  return static_cast<double>(variance_group) * squared_variation(mine.group_variances);
}

std::optional<double> planned_log_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged) {
  // The spread of ln s2 is 2 for a normal law. A mean's excess kurtosis falls like 1 / its size.
  const auto of_variance = [&](double spread) { return 2 + (spread - 2) / averaged; };
  if (question.kind == QuestionKind::total_variance || question.test->cost == CostKind::seconds) {
    if (!(pilot.values.m2 > 0)) return std::nullopt;
    return of_variance(pilot.values.kurtosis() - 1);
  }
  if (pilot.with_cost.empty()) return std::nullopt;
  const JointMoments& sample = by_its_cost(question, pilot.with_cost);
  if (!(sample.cost.mean > 0)) return std::nullopt;
  if (question.kind == QuestionKind::cost) return squared_variation(sample.cost) / averaged;
  if (!(sample.x.m2 > 0)) return std::nullopt;
  // The error's spread about the truth is at most that about the mean, unless bias dominates.
  return of_variance(stats::log_efficiency_of(sample).spread);
}

}  // namespace assay::harness
