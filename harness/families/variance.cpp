#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/families/log_theta.h"
#include "harness/families/lost_to_rounding.h"
#include "harness/families/spread_choice.h"
#include "harness/plan/rows.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "harness/theta/constant.h"
#include "harness/theta/inversion.h"
#include "stats/gates/assumption_gates.h"
#include "stats/variances/chi_square_variance.h"
#include "stats/variances/f_ratio.h"
#include "stats/variances/log_variance.h"

namespace assay::harness {
namespace {

using stats::Moments;

/// theta = ln(Var x per primary / v0).
Evidence variance_against_number(bool chi_square, const Method& method, const Question& question,
                                 std::size_t channel, const ChannelData& data) {
  const Moments x = data.moments;
  const double null =
      question.references[channel].value / question.subjects[0].averaged(data.primaries);
  const double excess = method.frozen.excess_kurtosis(channel).x;
  const auto at = [=](double theta) {
    const double variance = null * std::exp(theta);
    return chi_square ? stats::chi_square_variance(x, variance, excess)
                      : stats::log_variance(x, variance);
  };
  const auto interval = [=](double confidence) {
    if (!chi_square) return stats::log_variance_interval(x, null, confidence);
    return map_ends(stats::chi_square_variance_interval(x, confidence, excess),
                    [=](double variance) { return std::log(variance / null); });
  };
  return {.estimate = std::log(x.variance() / null),
          .at = at,
          .interval = interval,
          .quantity = "variance over the reference",
          .ratio = true};
}

/// theta = ln(Var x / (c Var y)), each per primary.
Evidence variance_against_variance(bool f, const Method& method, const Question& question,
                                   std::size_t channel, std::span<const ChannelData> data) {
  const Moments x = data[0].moments;
  const Moments y = data[1].moments;
  const double null = question.factor * question.subjects[1].averaged(data[1].primaries) /
                      question.subjects[0].averaged(data[0].primaries);
  const stats::ExcessKurtoses excess = method.frozen.excess_kurtosis(channel);
  const auto at = [=](double theta) {
    const double ratio = null * std::exp(theta);
    return f ? stats::f_ratio(x, y, ratio, excess) : stats::log_variance_ratio(x, y, ratio);
  };
  const auto interval = [=](double confidence) {
    if (f) {
      return map_ends(stats::f_ratio_interval(x, y, confidence, excess),
                      [=](double ratio) { return std::log(ratio / null); });
    }
    return map_ends(stats::log_variance_ratio_interval(x, y, confidence),
                    [=](double ln_ratio) { return ln_ratio - std::log(null); });
  };
  return {.estimate = std::log(x.variance() / y.variance() / null),
          .at = at,
          .interval = interval,
          .quantity = "ratio of variances",
          .ratio = true};
}

/// Evidence about one or two variances, by the exact test of normal values or by logarithms.
template <bool exact>
Evidence of_variances(const Method& method, const Question& question, std::size_t channel,
                      std::span<const ChannelData> data) {
  if (question.of_two()) return variance_against_variance(exact, method, question, channel, data);
  return variance_against_number(exact, method, question, channel, data[0]);
}

double secondary_kurtosis(const stats::Moments& pilot, double primaries) {
  return 3 + (pilot.kurtosis() - 3) / primaries;
}

/// The kurtosis of a subject's secondaries; nullopt if its pilot has no spread.
std::optional<double> planned_kurtosis(const Question& question, std::size_t subject,
                                       std::size_t channel, const Pilots& pilots,
                                       const Plan& plan) {
  const Moments& pilot = pilot_channel(question, subject, channel, pilots).moments;
  if (is_constant(question, subject, channel, pilot)) return std::nullopt;
  return secondary_kurtosis(pilot, question.subjects[subject].averaged(plan.primaries[subject]));
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
  VarianceTheta()
      : LogTheta({.of_moments = true, .of_spread = true, .rests_on_tails = true}, "variances") {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"F",
         "F: two variances of near-normal values",
         [](const Question& q) { return q.of_two(); },
         Keeps::moments,
         of_variances<true>,
         {.of_normal_values = true,
          .scores = true,
          .over_looks = stats::LookLaw::independent_increments}},
        {"chi-square",
         "chi-square: a variance of near-normal values",
         [](const Question& q) { return !q.of_two(); },
         Keeps::moments,
         of_variances<true>,
         {.of_normal_values = true,
          .scores = true,
          .over_looks = stats::LookLaw::independent_increments}},
        {"log-variance", "normal law of the logarithm of a variance: values of any shape",
         any_question, Keeps::moments, of_variances<false>}};
    return table;
  }

  std::optional<ThetaError> error(const Question& question, std::size_t channel,
                                  std::span<const ChannelData> data) const override {
    ThetaError error;
    for (std::size_t i = 0; i < data.size(); ++i) {
      double& part = question.subjects[i].setup->observations() ? error.fixed : error.drawn;
      part = std::hypot(part, stats::log_variance_standard_error(data[i].moments));
    }
    if (!question.references.empty()) {
      error.fixed = std::hypot(error.fixed, question.references[channel].standard_error);
    }
    return error;
  }

  std::uint64_t choose(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    return choose_for_variance(question, place, pilots, most, plan);
  }

  std::string hint(const Question& question) const override {
    return question.of_two() ? rows_beside_primaries(question) : "";
  }

  PlannedChannel observed(const Question& question, const Regions& regions, std::size_t,
                          std::span<const ChannelData> data) const override {
    PlannedChannel observed{.regions = regions, .kurtosis = data[0].moments.kurtosis()};
    if (question.of_two()) observed.other_kurtosis = data[1].moments.kurtosis();
    return observed;
  }

  std::optional<ConstantVerdict> settled(const Question& question, std::size_t channel,
                                         std::span<const ChannelData> data, const Regions& regions,
                                         const ErrorShare&) const override {
    if (question.of_two()) return std::nullopt;
    return judge_constant_variance(question, channel, data[0], regions);
  }

  std::string lack_of_numbers(const DrawnTest& test, std::size_t channel,
                              std::span<const ChannelData> data) const override {
    const std::string reason = Theta::lack_of_numbers(test, channel, data);
    return reason.empty() ? lack_of_variance(test.outcome.question, channel, data) : reason;
  }

  std::vector<Gate> gates(const TestOutcome& outcome, std::size_t channel,
                          std::span<const ChannelData> data, double) const override {
    std::vector<Gate> gates;
    const Question& question = outcome.question;
    for (std::size_t subject = 0; subject < data.size(); ++subject) {
      const Moments& moments = data[subject].moments;
      // Three values cannot show a kurtosis.
      if (!outcome.plan.method.is.of_normal_values || !(moments.m2 > 0) || moments.count <= 3) {
        continue;
      }
      gates.push_back(gate_of(
          stats::kurtosis_gate(moments),
          channel_suffix(question, channel) + " of " + question.subjects[subject].estimator->name));
    }
    return gates;
  }

 private:
  std::optional<PlannedChannel> from_pilots(const Question& question, std::size_t channel,
                                            const Pilots& pilots, const Plan& plan) const override {
    PlannedChannel planned{.regions = plan.regions[channel]};
    for (std::size_t i = 0; i < question.subjects.size(); ++i) {
      const auto kurtosis = planned_kurtosis(question, i, channel, pilots, plan);
      if (!kurtosis) return std::nullopt;
      (i == 0 ? planned.kurtosis : planned.other_kurtosis) = *kurtosis;
    }
    return planned;
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
