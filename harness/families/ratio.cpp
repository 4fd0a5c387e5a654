// Families whose theta is the logarithm of a ratio of positive quantities: variances, costs,
// efficiencies. Each quantity is known by its influence values (stats/variances/influence.h).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "harness/theta/ask.h"
#include "stats/gates/assumption_gates.h"
#include "stats/means/theta_of_means.h"
#include "stats/variances/normal_variances.h"

namespace assay::harness {
namespace {

using stats::Influence;
using stats::JointMoments;
using stats::Moments;
using stats::RatioSide;

RatioSide without_truth(const Influence& influence) {
  return {.influence = [influence](double) { return influence; }};
}

struct RatioWords {
  const char* one;   // "cost"
  const char* many;  // "costs"
};

/// The variance of one observation's influence values of a variance, over its square. It is 2 for a
/// normal law. A mean's excess kurtosis falls like 1 / its size.
double averaged_spread(double of_one, double averaged) { return 2 + (of_one - 2) / averaged; }

class LogTheta : public Theta {
 public:
  LogTheta(const ThetaTraits& traits, RatioWords named, std::vector<Method> rows)
      : Theta(traits, std::move(rows)), words(named) {}

  void check_margin(const Question& question, const Margin& margin) const override {
    Theta::check_margin(question, margin);
    if (margin.relative || !question.of_two()) return;
    refuse(margin.where, "a margin on a ratio of {} is relative; give it in per cent", words.many);
  }

  std::optional<ThetaError> error(const Seen& seen) const override {
    const Question& question = seen.question;
    ThetaError error;
    for (std::size_t i = 0; i < question.compared(); ++i) {
      const std::optional<double> spread = this->spread(seen, i);
      if (!spread) return std::nullopt;
      double& part = question.subjects[i].setup->observations() ? error.fixed : error.drawn;
      const double count = static_cast<double>(seen.moments(i).count);
      part = std::hypot(part, std::sqrt(*spread / count));
      // A drawn reference is new in every run.
      double& of_truth = question.has_reference_subject ? error.drawn : error.fixed;
      of_truth = std::hypot(of_truth, std::sqrt(spread_of_truth(seen, i) / count));
    }
    return error;
  }

  std::uint64_t choose(TestOutcome& test, const Pilots&) const override {
    return std::max(usual_secondaries, secondaries_of_floor(test));
  }

  std::optional<std::uint64_t> secondaries_of(const TestOutcome& test, std::size_t i,
                                              const stats::ErrorRates& rates,
                                              const Pilots& pilots) const override {
    const auto channel = planned(test, i, pilots);
    if (!channel) return std::nullopt;
    return secondaries_by_t(test.plan.method, rates, *channel);
  }

  /// The plan of one channel; nullopt if a pilot has no spread there.
  std::optional<PlannedChannel> planned(const TestOutcome& test, std::size_t channel,
                                        const Pilots& pilots) const override {
    const Question& question = test.question;
    // Variances alone are foretold of rows.
    if (has_rows(question) && !is.of_moments) return std::nullopt;
    if (!all_piloted(question, pilots)) return std::nullopt;
    PlannedChannel planned{.regions = test.plan.regions[channel]};
    for (std::size_t i = 0; i < question.compared(); ++i) {
      const std::optional<double> spread = pilot_spread(test, i, channel, pilots);
      if (!spread) return std::nullopt;
      planned.deviations[i] = std::sqrt(*spread);
    }
    if (!planned.varies()) return std::nullopt;
    return planned;
  }

  PlannedChannel observed(const Seen& seen, const Regions& regions) const override {
    PlannedChannel observed{.regions = regions};
    for (std::size_t i = 0; i < seen.question.compared(); ++i) {
      observed.deviations[i] = std::sqrt(spread(seen, i).value_or(0) + spread_of_truth(seen, i));
    }
    return observed;
  }

  std::optional<ConstantVerdict> settled(const TestOutcome& test, const Seen& seen) const override {
    const auto verdict = Theta::settled(test, seen);
    const bool of_one_variance = is.of_spread && !is.joins_channels;
    return !verdict && of_one_variance ? invalid(lack_of_spread(seen)) : verdict;
  }

  std::vector<Gate> gates(const TestOutcome& outcome, const Seen& seen,
                          double critical) const override {
    const Question& question = outcome.question;
    std::vector<Gate> gates;
    if (outcome.plan.method.keeps == Keeps::blocks) return gates;
    const std::string name = channel_suffix(question, seen.channel);
    std::vector<Moments> sides;
    double spread = 0;
    for (std::size_t i = 0; i < question.compared(); ++i) {
      const std::optional<Influence> influence = this->influence(seen, i);
      if (!influence) return gates;
      sides.push_back(influence->relative);
      spread += influence->relative.m2;
    }
    if (spread == 0) return gates;
    gates.push_back(gate_of(stats::effective_observations_gate(sides), name));
    gates.push_back(gate_of(sides.size() == 2
                                ? stats::residual_skewness_gate(sides[0], sides[1], 1, critical)
                                : stats::residual_skewness_gate(sides[0], {.value = 1}, critical),
                            name));
    return gates;
  }

  /// A subject's side of the ratio. Throws std::domain_error if it has none.
  virtual RatioSide side(const Seen&, std::size_t subject) const = 0;
  /// True if the data tell a subject's influence values.
  virtual bool tells(const ChannelData&) const = 0;
  /// ln of the ratio, or of the one quantity, where theta is 0.
  virtual double log_null(const Seen& seen) const {
    const Question& question = seen.question;
    return std::log(question.of_two() ? question.factor : seen.reference().value);
  }

  virtual bool is_inverse() const { return false; }

  /// The variance of an observation's influence values over the quantity's square; by default that
  /// of a variance. An observation averages `averaged` of the pilot's single primaries.
  virtual std::optional<double> predicted_spread(const Question&, const ChannelData& pilot,
                                                 double averaged) const {
    if (!(pilot.moments.m2 > 0)) return std::nullopt;
    return averaged_spread(pilot.moments.kurtosis() - 1, averaged);
  }

  /// The same from the test's own data.
  virtual std::optional<double> spread(const Seen& seen, std::size_t subject) const {
    const std::optional<Influence> influence = this->influence(seen, subject);
    if (!influence) return std::nullopt;
    const double error = influence->relative.standard_error();
    return static_cast<double>(seen.moments(subject).count) * error * error;
  }

  /// Count times the variance that the truth's own error makes.
  virtual double spread_of_truth(const Seen&, std::size_t) const { return 0; }

  const RatioWords words;

 private:
  /// A subject's influence values, with the truth as known; nullopt if the data do not tell.
  std::optional<Influence> influence(const Seen& seen, std::size_t subject) const {
    if (!tells(seen.data[subject])) return std::nullopt;
    const RatioSide side = this->side(seen, subject);
    return side.influence(side.truth.known.value);
  }

  std::optional<double> pilot_spread(const TestOutcome& test, std::size_t subject,
                                     std::size_t channel, const Pilots& pilots) const {
    const Subject& side = test.question.subjects[subject];
    const double averaged = side.averaged(test.plan.primaries[subject]);
    std::optional<double> most;
    for (std::size_t i = 0; i < side.channels.size(); ++i) {
      if (!is.joins_channels && i != channel) continue;
      const ChannelData seen = pilot_channel(side, *pilot_of(side, pilots), i);
      const auto spread = predicted_spread(test.question, seen, averaged);
      if (spread) most = std::max(most.value_or(0), *spread);
    }
    return most;
  }
};

/// Names theta before its logarithm: "ratio of costs", "cost over the reference".
Evidence named(Evidence evidence, const Question& question) {
  const RatioWords& words = dynamic_cast<const LogTheta&>(*question.theta).words;
  evidence.quantity = question.of_two() ? fmt::format("ratio of {}", words.many)
                                        : fmt::format("{} over the reference", words.one);
  return evidence;
}

Evidence by_influence(const Seen& seen) {
  const auto& family = dynamic_cast<const LogTheta&>(*seen.question.theta);
  stats::LogRatio ratio{.log_null = family.log_null(seen),
                        .sign = family.is_inverse() ? -1.0 : 1.0};
  for (std::size_t i = 0; i < seen.question.compared(); ++i) {
    ratio.sides.push_back(family.side(seen, i));
  }
  return named(stats::log_ratio_evidence(ratio), seen.question);
}

Method influence_row(bool (*answers)(const Question&), Keeps keeps) {
  return {
      "influence-t",
      "t of influence values, with and without Hall's correction: variances, costs, efficiencies",
      answers,
      keeps,
      by_influence,
      of_scores};
}

/// The variance of the first over that of the second, or over the number, where theta is 0.
double null_of(const Seen& seen) {
  const Question& question = seen.question;
  const double x = question.subjects[0].averaged(seen.data[0].primaries);
  if (!question.of_two()) return seen.reference().value / x;
  return question.factor * question.subjects[1].averaged(seen.data[1].primaries) / x;
}

Evidence of_normal_values(const Seen& seen) {
  const bool two = seen.question.of_two();
  return named(
      stats::log_variance_evidence(
          seen.moments(0), two ? std::optional(seen.moments(1)) : std::nullopt, null_of(seen)),
      seen.question);
}

/// True if the pilot leaves no doubt that F and chi-square keep their level: no excess kurtosis
/// above the limit. Adds a gate for each channel.
bool are_near_normal(const Question& question, const std::vector<Known>& channels, double limit,
                     std::vector<stats::Gate>& gates) {
  bool normal = channels.size() == question.subjects.size() * question.channel_count();
  for (const Known& known : channels) {
    gates.push_back(stats::small_kurtosis_gate(known.pilot.moments, known.averaged, limit));
    normal = normal && !known.rows && gates.back().state == stats::GateState::green;
  }
  return normal;
}

/// Says that a row is held against a primary, if one side of two is a file; else "".
std::string rows_beside_primaries(const Question& question) {
  for (std::size_t i = 0; i < 2; ++i) {
    const Subject& rows = question.subjects[i];
    const Subject& other = question.subjects[1 - i];
    if (!is_recorded(rows) || !other.averages) continue;
    return fmt::format(
        "a row of `{}` is compared with a single primary of `{}`: if a row is a mean of n, its "
        "variance is n times less, and the claim needs a factor n",
        rows.estimator->name, other.estimator->name);
  }
  return "";
}

/// The spread that rounding may hide, by the size of the values or as declared.
double hidden_deviation(const Seen& seen) {
  const double averaged = seen.question.subjects[0].averaged(seen.data[0].primaries);
  const double size = std::abs(seen.moments(0).mean) * averaged;
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return std::max(spacing, 2 * rounding_of(seen.question.subjects[0], seen.channel));
}

constexpr MethodTraits for_normal_values{.of_normal_values = true,
                                         .over_looks = stats::LookLaw::independent_increments};

/// theta = ln(Var x / v0), or ln(Var x / (c Var y)), each of one primary if the estimator averages.
class VarianceTheta final : public LogTheta {
 public:
  VarianceTheta()
      : LogTheta({.logarithm = true, .of_moments = true, .of_spread = true},
                 {"variance", "variances"},
                 {{"F", "F: two variances of near-normal values", of_two, Keeps::moments,
                   of_normal_values, for_normal_values},
                  {"chi-square", "chi-square: a variance of near-normal values", of_one,
                   Keeps::moments, of_normal_values, for_normal_values},
                  influence_row(any_question, Keeps::powers)}) {}

  std::uint64_t choose(TestOutcome& test, const Pilots& pilots) const override {
    const Question& question = test.question;
    const auto channels = known_channels(test, pilots);
    const double limit = kurtosis_limit(question, test.place);
    std::vector<stats::Gate> gates;
    const bool normal = are_near_normal(question, channels, limit, gates);
    if (!question.test->method && !normal) test.plan.method = find_method(question, "influence-t");
    if (!test.plan.method.is.of_normal_values) return LogTheta::choose(test, pilots);
    for (std::size_t i = 0; i < channels.size(); ++i) note(test.plan, channels[i], gates[i]);
    return secondaries_of_floor(test);
  }

  /// Allows "at most" and "below" for the largest variance of several channels: every channel's is
  /// bounded then.
  Question bind(const TestEntry& test, const Estimators& estimators) const override {
    const Claim& claim = test.claim;
    Question question = Theta::bind(test, estimators);
    const std::size_t channels = question.channel_count();
    const bool bounds_each = is_upper(claim.relation) && !question.of_two();
    if (claim.left.row->over_all_channels && channels > 1 && !bounds_each) {
      refuse(claim.left.where,
             "`{}` of {} channels can only be claimed to be below a number (`<=` or `<`)",
             claim.left.row->word, channels);
    }
    return question;
  }

  std::string caveat(const DrawnTest& test) const override {
    const Question& question = test.outcome.question;
    return question.of_two() ? rows_beside_primaries(question) : "";
  }

  /// Passes a constant sample if the claim bounds its variance from above and forbids no region, as
  /// each channel of `worst_variance`. Rounding must hide no variance beyond the bound.
  std::optional<ConstantVerdict> settled(const TestOutcome& test, const Seen& seen) const override {
    const Regions& regions = test.plan.regions[seen.channel];
    const bool bounds = !seen.question.of_two() && regions.relation == Relation::at_most;
    if (!bounds || regions.has_forbidden() || !is_constant(seen, 0) ||
        std::pow(hidden_deviation(seen), 2) > seen.reference().value) {
      return LogTheta::settled(test, seen);
    }
    return ConstantVerdict{reports::Verdict::pass,
                           fmt::format("every observation is {:.10g}, so the variance seen is 0, "
                                       "which is not too large; unseen values are not ruled out",
                                       seen.moments(0).mean)};
  }

  std::vector<Gate> gates(const TestOutcome& outcome, const Seen& seen,
                          double critical) const override {
    if (!outcome.plan.method.is.of_normal_values) return LogTheta::gates(outcome, seen, critical);
    std::vector<Gate> gates;
    const std::string name = channel_suffix(seen.question, seen.channel);
    for (std::size_t subject = 0; subject < seen.data.size(); ++subject) {
      const Moments& moments = seen.moments(subject);
      // Three values cannot show a kurtosis.
      if (!(moments.m2 > 0) || moments.count <= 3) continue;
      gates.push_back(gate_of(stats::kurtosis_gate(moments),
                              name + " of " + seen.question.subjects[subject].estimator->name));
    }
    return gates;
  }

 private:
  RatioSide side(const Seen& seen, std::size_t subject) const override {
    return without_truth(stats::influence_of_variance(powers_of_values(seen.data[subject])));
  }
  // Fewer do not tell a kurtosis.
  bool tells(const ChannelData& data) const override { return data.moments.count >= 4; }
  double log_null(const Seen& seen) const override { return std::log(null_of(seen)); }
};

const JointMoments& by_its_cost(const Question& question, std::span<const JointMoments> joint) {
  return joint[question.test->cost == CostKind::samples ? samples_cost : rays_cost];
}

/// The truth about which a subject's mean squared error stands for the variance; nullopt if none
/// does.
std::optional<Constant> truth_beside(const Seen& seen, std::size_t subject) {
  if (seen.question.truths[subject].empty()) return std::nullopt;
  return truth_of(seen, subject);
}

/// ln(seconds per primary) of each replicate; for efficiency -ln(seconds * variance of a primary).
Moments logarithms(const Seen& seen, std::size_t subject) {
  const ChannelData& data = seen.data[subject];
  const double primaries = seen.question.subjects[subject].averaged(data.primaries);
  Moments logs;
  for (const Replicate& replicate : data.replicates) {
    const double seconds = replicate.seconds / static_cast<double>(replicate.count) / primaries;
    if (!seen.question.is().of_spread) {
      logs.add(std::log(seconds));
    } else {
      logs.add(-std::log(seconds * replicate.moments.variance() * primaries));
    }
  }
  if (!std::isfinite(logs.mean)) {
    throw std::domain_error("a replicate took no measurable time or did not vary");
  }
  return logs;
}

/// Costs and efficiencies in seconds, from replicates: Student's or Welch's t on the logarithms of
/// their costs, or of cost x variance. The mean logarithm is off by about 1 / replicate size, alike
/// on both sides.
Evidence evidence_of_replicates(const Seen& seen) {
  const Question& question = seen.question;
  const double null = question.of_two() ? question.factor : seen.reference().value;
  stats::ThetaOfMeans theta{.test = stats::mean_by_t,
                            .x = {.moments = logarithms(seen, 0), .range = {}},
                            .contrast = {.offset = std::log(null)}};
  if (question.of_two()) theta.y = stats::MeanSample{logarithms(seen, 1), {}};
  return named(theta.evidence(), question);
}

bool in_seconds(const Question& question) { return question.test->cost == CostKind::seconds; }
bool in_counts(const Question& question) { return !in_seconds(question); }

/// Claims in counts go by influence values, claims in seconds by replicates.
class RatioTheta : public LogTheta {
 public:
  using LogTheta::LogTheta;

 protected:
  static std::vector<Method> rows(const char* of_replicates) {
    return {influence_row(in_counts, Keeps::costs),
            {"replicates", of_replicates, in_seconds, Keeps::blocks, evidence_of_replicates}};
  }
  std::optional<double> spread(const Seen& seen, std::size_t subject) const override {
    const ChannelData& mine = seen.data[subject];
    if (mine.replicates.empty()) return LogTheta::spread(seen, subject);
    const double per_count =
        static_cast<double>(mine.moments.count) / static_cast<double>(mine.replicates.size());
    return per_count * logarithms(seen, subject).variance();
  }
  std::optional<double> predicted_spread(const Question& question, const ChannelData& pilot,
                                         double averaged) const final {
    if (in_seconds(question)) return LogTheta::predicted_spread(question, pilot, averaged);
    if (pilot.joint.empty()) return std::nullopt;
    return counted_spread(by_its_cost(question, pilot.joint), averaged);
  }
  /// The same of a claim in counts, from single primaries with their cost.
  virtual std::optional<double> counted_spread(const JointMoments& pilot,
                                               double averaged) const = 0;
  bool tells(const ChannelData& data) const override { return !data.joint.empty(); }
};

class CostTheta final : public RatioTheta {
 public:
  CostTheta()
      : RatioTheta({.joins_channels = true, .logarithm = true}, {"cost", "costs"},
                   rows("t of replicates: costs in seconds")) {}

  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question&, std::size_t) const override { return "cost"; }

 protected:
  RatioSide side(const Seen& seen, std::size_t subject) const override {
    return without_truth(cost_of(seen, subject));
  }
  std::optional<double> counted_spread(const JointMoments& pilot, double averaged) const override {
    const Moments cost = pilot.cost();
    if (!(cost.mean > 0)) return std::nullopt;
    return stats::influence_of_mean(cost).relative.variance() / averaged;
  }
};

/// Values with their cost, in rays or samples. Throws std::domain_error if nothing was counted.
const JointMoments& counted_cost(const Question& question, const ChannelData& data) {
  const JointMoments& sample = by_its_cost(question, data.joint);
  if (sample.of_cost.mean > 0) return sample;
  throw std::domain_error("no cost was counted: the estimator traces no rays; write " +
                          written_key(*question.test, "cost", "samples"));
}

class EfficiencyTheta final : public RatioTheta {
 public:
  EfficiencyTheta()
      : RatioTheta({.logarithm = true, .of_spread = true}, {"efficiency", "efficiencies"},
                   rows("t of replicates: efficiencies in seconds")) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override;

 protected:
  /// Error times cost, the inverse of the efficiency.
  RatioSide side(const Seen& seen, std::size_t subject) const override {
    const JointMoments sample = counted_cost(seen.question, seen.data[subject]);
    const auto truth = truth_beside(seen, subject);
    if (!truth) return without_truth(stats::influence_of_variance_and_cost(sample));
    return {
        .influence = [sample](double t) { return stats::influence_of_error_and_cost(sample, t); },
        .truth = {.known = *truth, .turn = sample.x().mean}};
  }
  bool is_inverse() const override { return true; }
  /// It moves ln(mean squared error), to first and second order. More observations do not reduce
  /// it.
  double spread_of_truth(const Seen& seen, std::size_t subject) const override {
    const auto truth = truth_beside(seen, subject);
    if (!truth) return 0;
    const Moments& x = seen.moments(subject);
    const double n = static_cast<double>(x.count);
    const double error = truth->standard_error;
    const double bias = x.mean_less(truth->value);
    const double squared = x.m2 / n + bias * bias;
    const double of_truth = error * std::sqrt(4 * bias * bias + 2 * error * error) / squared;
    return n * of_truth * of_truth;
  }
  std::optional<double> counted_spread(const JointMoments& pilot, double averaged) const override {
    if (!(pilot.of_cost.mean > 0) || !(pilot.sum(2, 0) > 0)) return std::nullopt;
    // The error's spread about the truth is at most that about the mean, unless bias dominates.
    return averaged_spread(stats::influence_of_variance_and_cost(pilot).relative.variance(),
                           averaged);
  }
};

class TotalVarianceTheta final : public LogTheta {
 public:
  TotalVarianceTheta()
      : LogTheta({.joins_channels = true, .logarithm = true, .of_spread = true},
                 {"total variance", "total variances"},
                 {influence_row(any_question, Keeps::group_variances)}) {}

  const Theta* of_images() const override { return this; }
  std::string channel_name(const Question& question, std::size_t channel) const override {
    return question.subjects[0].channels.size() > 1 ? "all channels"
                                                    : Theta::channel_name(question, channel);
  }

 protected:
  RatioSide side(const Seen& seen, std::size_t subject) const override {
    const ChannelData& data = seen.data[subject];
    const Subject& side = seen.question.subjects[subject];
    if (!(data.group_variances.mean > 0)) {
      throw std::domain_error("no channel of `" + side.estimator->name +
                              "` varies: it has no total variance");
    }
    Influence total = stats::influence_of_mean(data.group_variances);
    total.log_value += std::log(side.averaged(data.primaries));
    return without_truth(total);
  }
  bool tells(const ChannelData& data) const override { return data.group_variances.count >= 2; }
};

}  // namespace

std::string lack_of_spread(const Seen& seen) {
  const Question& question = seen.question;
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    if (is_constant(seen, subject)) {
      return fmt::format(
          "every observation of `{}` is {:.10g} but for rounding: a sample without spread does "
          "not show its own error, and a rare value may be unseen; {}",
          question.subjects[subject].estimator->name, seen.moments(subject).mean,
          question.of_two() ? "compare the other with a number, or take more observations"
                            : "see that it uses its random numbers, or take more observations");
    }
  }
  return "";
}

JointMoments powers_of_values(const ChannelData& data) {
  return data.joint.empty() ? stats::joint_of_four(data.moments) : data.joint.front();
}

Influence cost_of(const Seen& seen, std::size_t subject) {
  const ChannelData& data = seen.data[subject];
  Influence cost = stats::influence_of_mean(counted_cost(seen.question, data).cost());
  cost.log_value -= std::log(seen.question.subjects[subject].averaged(data.primaries));
  return cost;
}

Constant truth_of(const Seen& seen, std::size_t subject) {
  const Question& question = seen.question;
  if (!question.has_reference_subject) return question.truths[subject][seen.channel];
  const Moments& reference = seen.data.back().moments;
  return {reference.mean, reference.standard_error()};
}

Question EfficiencyTheta::bind(const TestEntry& test, const Estimators& estimators) const {
  Question question = Theta::bind(test, estimators);
  const bool asked = test.reference || test.reference_number;
  const std::vector<Source> sources = sources_of(test.claim);
  question.truths.resize(question.subjects.size());
  bool any = false;
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& subject = question.subjects[i];
    const BiasClass bias = subject.estimator->nature().bias.value_or(BiasClass::unbiased);
    if (!asked && bias == BiasClass::unbiased) continue;
    if (subject.averages && !subject.estimator->primaries) {
      refuse(subject.estimator->where,
             "the mean squared error of `{0}` depends on how many primaries it averages: give the "
             "number, as in `{0}: {{…, primaries: 16}}`",
             subject.estimator->name);
    }
    any = true;
    question.truths[i] = truths_of(test, subject, sources[i]);
  }
  if (any && test.cost == CostKind::seconds) {
    refuse(test.where, "a mean squared error per second has no method; count `rays` or `samples`");
  }
  add_reference(question, estimators);
  return question;
}

const Theta& theta_of_variances() { return one<VarianceTheta>(); }
const Theta& theta_of_costs() { return one<CostTheta>(); }
const Theta& theta_of_efficiencies() { return one<EfficiencyTheta>(); }
const Theta& theta_of_total_variances() { return one<TotalVarianceTheta>(); }

}  // namespace assay::harness
