#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "harness/families/log_theta.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "harness/theta/constant.h"
#include "stats/means/student_t.h"

namespace assay::harness {
namespace {

using stats::JointMoments;
using stats::Moments;

/// Count times the variance of ln(mean squared error) that the truth's own error makes, to first
/// and second order. More observations do not reduce it.
double spread_of_truth(const Moments& x, const Constant& truth) {
  const double n = static_cast<double>(x.count);
  const double error = truth.standard_error;
  const double bias = x.mean_less(truth.value);
  const double squared = x.m2 / n + bias * bias;
  const double of_truth = error * std::sqrt(4 * bias * bias + 2 * error * error) / squared;
  return n * of_truth * of_truth;
}

stats::Influence cost_of(const Question& question, std::size_t subject, const ChannelData& data) {
  stats::Influence cost = stats::influence_of_mean(counted_cost(question, data).cost());
  cost.log_value -= std::log(question.subjects[subject].averaged(data.primaries));
  return cost;
}

stats::Influence total_variance_of(const Question& question, std::size_t subject,
                                   const ChannelData& data) {
  if (!(data.group_variances.mean > 0)) {
    throw std::domain_error("no channel of `" + question.subjects[subject].estimator->name +
                            "` varies: it has no total variance");
  }
  stats::Influence total = stats::influence_of_mean(data.group_variances);
  total.log_value += std::log(question.subjects[subject].averaged(data.primaries));
  return total;
}

/// The truth about which a subject's mean squared error stands for the variance; nullopt if none
/// does.
std::optional<Constant> truth_beside(const Question& question, std::size_t subject,
                                     std::size_t channel, std::span<const ChannelData> data) {
  if (question.truths[subject].empty()) return std::nullopt;
  return truth_of(question, subject, channel, data);
}

/// Error times cost, the inverse of the efficiency.
RatioSide inverse_efficiency(const Question& question, std::size_t subject, std::size_t channel,
                             std::span<const ChannelData> data) {
  const JointMoments sample = counted_cost(question, data[subject]);
  const auto truth = truth_beside(question, subject, channel, data);
  if (!truth) return without_truth(stats::influence_of_variance_and_cost(sample));
  return {.influence = [sample](double t) { return stats::influence_of_error_and_cost(sample, t); },
          .truth = {.known = {truth->value, truth->standard_error}, .turn = sample.x().mean}};
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

/// Costs and efficiencies in seconds, from replicates: Student's or Welch's t on the logarithms of
/// their costs, or of cost x variance. The mean logarithm is off by about 1 / replicate size, alike
/// on both sides.
Evidence evidence_of_replicates(const Method&, const Question& question, std::size_t channel,
                                std::span<const ChannelData> data) {
  const Moments x = logarithms(question, 0, data[0]);
  if (!question.of_two()) {
    const double null = std::log(question.references[channel].value);
    return {.estimate = x.mean - null,
            .at = [=](double t) { return stats::student_t(x, {.value = null + t}); },
            .interval =
                [=](double confidence) {
                  return stats::student_t_interval(x, {.value = null}, confidence);
                },
            .quantity = quantity_of(question),
            .ratio = true};
  }
  Moments y = logarithms(question, 1, data[1]);
  y.mean += std::log(question.factor);
  return {.estimate = x.mean - y.mean,
          .at = [=](double t) { return stats::welch_t(x, y, {.scale = 1, .offset = t}); },
          .interval = [=](double confidence) { return stats::welch_t_interval(x, y, confidence); },
          .quantity = quantity_of(question),
          .ratio = true};
}

bool in_seconds(const Question& question) { return question.test->cost == CostKind::seconds; }
bool in_counts(const Question& question) { return !in_seconds(question); }

/// Claims in counts go by influence values, claims in seconds by replicates.
class RatioTheta : public LogTheta {
 public:
  using LogTheta::LogTheta;

 protected:
  static std::vector<MethodRow> rows(const char* of_replicates) {
    return {influence_row(in_counts, Keeps::costs),
            {"replicates", of_replicates, in_seconds, Keeps::blocks, evidence_of_replicates}};
  }
  std::optional<double> spread(const Question& question, std::size_t subject, std::size_t channel,
                               std::span<const ChannelData> data) const override {
    const ChannelData& mine = data[subject];
    if (mine.replicates.empty()) return LogTheta::spread(question, subject, channel, data);
    const double per_count =
        static_cast<double>(mine.moments.count) / static_cast<double>(mine.replicates.size());
    return per_count * logarithms(question, subject, mine).variance();
  }
};

class CostTheta final : public RatioTheta {
 public:
  CostTheta() : RatioTheta({.joins_channels = true}, {"cost", "costs"}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table = rows("t of replicates: costs in seconds");
    return table;
  }
  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question&, std::size_t) const override { return "cost"; }

 protected:
  RatioSide side(const Question& question, std::size_t subject, std::size_t,
                 std::span<const ChannelData> data) const override {
    return without_truth(cost_of(question, subject, data[subject]));
  }
  bool tells(const ChannelData& data) const override { return !data.joint.empty(); }
  std::optional<double> predicted_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged) const override {
    if (in_seconds(question)) return RatioTheta::predicted_spread(question, pilot, averaged);
    if (pilot.joint.empty()) return std::nullopt;
    const Moments cost = by_its_cost(question, pilot.joint).cost();
    if (!(cost.mean > 0)) return std::nullopt;
    return stats::influence_of_mean(cost).relative.variance() / averaged;
  }
};

class EfficiencyTheta final : public RatioTheta {
 public:
  EfficiencyTheta() : RatioTheta({.of_spread = true}, {"efficiency", "efficiencies"}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table = rows("t of replicates: efficiencies in seconds");
    return table;
  }

 protected:
  RatioSide side(const Question& question, std::size_t subject, std::size_t channel,
                 std::span<const ChannelData> data) const override {
    return inverse_efficiency(question, subject, channel, data);
  }
  bool tells(const ChannelData& data) const override { return !data.joint.empty(); }
  bool is_inverse() const override { return true; }
  double spread_of_truth(const Question& question, std::size_t subject, std::size_t channel,
                         std::span<const ChannelData> data) const override {
    const auto truth = truth_beside(question, subject, channel, data);
    return truth ? harness::spread_of_truth(data[subject].moments, *truth) : 0;
  }
  std::optional<double> predicted_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged) const override {
    if (in_seconds(question)) return RatioTheta::predicted_spread(question, pilot, averaged);
    if (pilot.joint.empty()) return std::nullopt;
    const JointMoments& sample = by_its_cost(question, pilot.joint);
    if (!(sample.of_cost.mean > 0) || !(sample.sum(2, 0) > 0)) return std::nullopt;
    // The error's spread about the truth is at most that about the mean, unless bias dominates.
    return averaged_spread(stats::influence_of_variance_and_cost(sample).relative.variance(),
                           averaged);
  }
};

class TotalVarianceTheta final : public RatioTheta {
 public:
  TotalVarianceTheta()
      : RatioTheta({.joins_channels = true, .of_spread = true},
                   {"total variance", "total variances"}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{influence_row(any_question, Keeps::group_variances)};
    return table;
  }
  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question& question, std::size_t channel) const override {
    return question.subjects[0].channels.size() > 1 ? "all channels"
                                                    : Theta::channel_name(question, channel);
  }

 protected:
  RatioSide side(const Question& question, std::size_t subject, std::size_t,
                 std::span<const ChannelData> data) const override {
    return without_truth(total_variance_of(question, subject, data[subject]));
  }
  bool tells(const ChannelData& data) const override { return data.group_variances.count >= 2; }
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
