#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "harness/families/log_theta.h"
#include "harness/plan/independence.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/sizes.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "harness/theta/constant.h"
#include "harness/theta/evidence.h"
#include "harness/theta/methods.h"
#include "stats/gates/assumption_gates.h"
#include "stats/variances/normal_variances.h"

namespace assay::harness {
namespace {

using stats::Moments;

/// The variance of the first over that of the second, or over the number, where theta is 0.
double null_of(const Question& question, std::size_t channel, std::span<const ChannelData> data) {
  const double x = question.subjects[0].averaged(data[0].primaries);
  if (!question.of_two()) return question.references[channel].value / x;
  return question.factor * question.subjects[1].averaged(data[1].primaries) / x;
}

/// By chi-square or F, for normal values.
Evidence of_normal_values(const Method&, const Question& question, std::size_t channel,
                          std::span<const ChannelData> data) {
  const Moments x = data[0].moments;
  const Moments y = question.of_two() ? data[1].moments : Moments{};
  const bool two = question.of_two();
  const double null = null_of(question, channel, data);
  const auto at = [=](double theta) {
    const double value = null * std::exp(theta);
    return two ? stats::f_ratio(x, y, value) : stats::chi_square_variance(x, value);
  };
  const auto interval = [=](double confidence) {
    return map_ends(two ? stats::f_ratio_interval(x, y, confidence)
                        : stats::chi_square_variance_interval(x, confidence),
                    [=](double value) { return std::log(value / null); });
  };
  return {.estimate = std::log(x.variance() / (two ? y.variance() : 1) / null),
          .at = at,
          .interval = interval,
          .quantity = quantity_of(question),
          .ratio = true};
}

/// True if the pilot leaves no doubt that F and chi-square keep their level. Adds a gate for each
/// channel.
bool are_near_normal(const Question& question, const std::vector<Known>& channels, double critical,
                     std::vector<stats::Gate>& gates) {
  const double limit = kurtosis_limit(critical);
  bool normal = channels.size() == question.subjects.size() * question.channel_count();
  for (const Known& known : channels) {
    constexpr std::uint64_t fewest_with_kurtosis = 4;
    const bool shows = known.pilot.moments.count >= fewest_with_kurtosis;
    const double upper = shows ? stats::kurtosis_upper_limit(known.pilot.moments) / known.averaged
                               : std::numeric_limits<double>::infinity();
    const bool green = upper <= limit;
    normal = normal && !known.rows && green;
    gates.push_back({.name = "upper limit of the excess kurtosis",
                     .value = upper,
                     .low = upper,
                     .limit = limit,
                     .state = green ? stats::GateState::green : stats::GateState::amber});
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
        "; a row of `{}` is held against a single primary of `{}`: rows that are means of n have a "
        "variance n times less, and the claim on them a factor n",
        rows.estimator->name, other.estimator->name);
  }
  return "";
}

/// theta = ln(Var x / v0), or ln(Var x / (c Var y)), each of one primary if the estimator averages.
class VarianceTheta final : public LogTheta {
 public:
  VarianceTheta() : LogTheta({.of_moments = true, .of_spread = true}, {"variance", "variances"}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"F",
         "F: two variances of near-normal values",
         [](const Question& q) { return q.of_two(); },
         Keeps::moments,
         of_normal_values,
         {.of_normal_values = true, .over_looks = stats::LookLaw::independent_increments}},
        {"chi-square",
         "chi-square: a variance of near-normal values",
         [](const Question& q) { return !q.of_two(); },
         Keeps::moments,
         of_normal_values,
         {.of_normal_values = true, .over_looks = stats::LookLaw::independent_increments}},
        influence_row(any_question, Keeps::powers)};
    return table;
  }

  std::uint64_t choose(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    const auto channels = known_channels(question, pilots, plan);
    const double x = critical_value(smallest_level(question, place),
                                    is_two_sided(question.test->claim.relation));
    std::vector<stats::Gate> gates;
    const bool normal = are_near_normal(question, channels, x, gates);
    if (!question.test->method && !normal) plan.method = find_method(question, "influence-t");
    if (!plan.method.is.of_normal_values) {
      return LogTheta::choose(question, place, pilots, most, plan);
    }
    for (std::size_t i = 0; i < channels.size(); ++i) note(plan, channels[i], gates[i]);
    return least_secondaries;
  }

  std::string hint(const Question& question) const override {
    return question.of_two() ? rows_beside_primaries(question) : "";
  }

  std::optional<ConstantVerdict> settled(const Question& question, std::size_t channel,
                                         std::span<const ChannelData> data, const Regions& regions,
                                         const ErrorShare&) const override {
    if (question.of_two()) return std::nullopt;
    return judge_constant_variance(question, channel, data[0], regions);
  }

  std::vector<Gate> gates(const TestOutcome& outcome, std::size_t channel,
                          std::span<const ChannelData> data, double critical) const override {
    if (!outcome.plan.method.is.of_normal_values) {
      return LogTheta::gates(outcome, channel, data, critical);
    }
    std::vector<Gate> gates;
    const Question& question = outcome.question;
    for (std::size_t subject = 0; subject < data.size(); ++subject) {
      const Moments& moments = data[subject].moments;
      // Three values cannot show a kurtosis.
      if (!(moments.m2 > 0) || moments.count <= 3) continue;
      gates.push_back(gate_of(
          stats::kurtosis_gate(moments),
          channel_suffix(question, channel) + " of " + question.subjects[subject].estimator->name));
    }
    return gates;
  }

 private:
  RatioSide side(const Question&, std::size_t subject, std::size_t,
                 std::span<const ChannelData> data) const override {
    return without_truth(stats::influence_of_variance(powers_of_values(data[subject])));
  }
  // Fewer do not tell a kurtosis.
  bool tells(const ChannelData& data) const override { return data.moments.count >= 4; }
  double log_null(const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) const override {
    return std::log(null_of(question, channel, data));
  }
};

const VarianceTheta variance_theta;

}  // namespace

Question bind_variance(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  Question question{.test = &test,
                    .theta = &variance_theta,
                    .subjects = {estimates(claim.left.source, estimators)}};
  if (const ScaledQuantity* const other = other_side(claim)) {
    question.factor = other->factor;
    question.subjects.push_back(estimates(other->quantity.source, estimators));
  } else {
    const auto* const number = std::get_if<Constant>(&claim.right);
    if (number != nullptr && number->standard_error > 0) {
      throw InputError(claim.left.where,
                       "a variance is tested against an exact number: `+-` has no method here");
    }
    question.references = references_of(claim, question.subjects[0], analytic_variance);
  }
  return question;
}

Question bind_worst_variance(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const Subject subject = estimates(claim.left.source, estimators);
  const bool bounded = claim.relation == Relation::at_most || claim.relation == Relation::less;
  const bool number = std::holds_alternative<Constant>(claim.right);
  if (subject.channels.size() == 1 || (bounded && number)) return bind_variance(test, estimators);
  throw InputError(claim.left.where,
                   fmt::format("`worst_variance` of {} channels is bounded by a number from above "
                               "(`<=` or `<`): that every channel's variance is; there is no "
                               "method for another claim",
                               subject.channels.size()));
}

const Theta& theta_of_variances() { return variance_theta; }

}  // namespace assay::harness
