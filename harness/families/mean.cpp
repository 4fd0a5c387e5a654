#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "harness/theta/ask.h"
#include "stats/basics/moments.h"
#include "stats/gates/assumption_gates.h"
#include "stats/means/power_exact.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/theta_of_means.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

using stats::GateState;
using stats::Moments;

stats::MeanSample sample_of(const stats::MeanTest& test, const Seen& seen, std::size_t subject) {
  const Moments& moments = seen.moments(subject);
  const Subject& side = seen.question.subjects[subject];
  stats::MeanSample sample{moments, range_of(side, seen.channel, moments),
                           rounding_of(side, seen.channel)};
  if (test.bets) {
    sample.cells = std::make_shared<const stats::ValueCells>(seen.data[subject].values);
  }
  return sample;
}

template <const stats::MeanTest& test>
Evidence evidence_of_means(const Seen& seen) {
  const Question& question = seen.question;
  stats::ThetaOfMeans theta{.test = test,
                            .x = sample_of(test, seen, 0),
                            .contrast = {.scale = question.factor, .offset = question.offset},
                            .relative = seen.relative()};
  if (question.of_two()) {
    theta.y = sample_of(test, seen, 1);
  } else {
    theta.reference = seen.reference();
  }
  Evidence evidence = theta.evidence();
  evidence.quantity = fmt::format("{}difference {}", theta.relative ? "relative " : "",
                                  theta.y ? "of means" : "from the reference");
  return evidence;
}

// A shift of so many standard errors moves a tail of one per cent by a third at most.
constexpr double tolerated_shift = 0.1;

/// Why means cannot be compared: rounding adds more than the tolerated shift; "" if it adds less.
std::string lost_to_rounding(const Seen& seen) {
  std::size_t worst = 0;
  double most = 0;
  double rounding = 0;
  double error = seen.question.of_two() ? 0 : seen.reference().standard_error;
  for (std::size_t subject = 0; subject < seen.data.size(); ++subject) {
    const Moments& moments = seen.moments(subject);
    if (moments.count < 2) continue;
    const double factor = seen.question.factor_of(subject);
    const double own = factor * stats::rounding_of_mean(moments);
    if (own > most) worst = subject;
    most = std::max(most, own);
    rounding = std::hypot(rounding, own);
    error = std::hypot(error, factor * moments.standard_error());
  }
  if (!(rounding > tolerated_shift * error)) return "";
  return fmt::format(
      "the mean of `{}` is {:.6g}: numbers of that size are rounded so coarsely that their mean is "
      "off by about {:.2g}, and the standard error is {:.2g}; subtract a constant near the mean "
      "from the observations",
      seen.question.subjects[worst].estimator->name, seen.moments(worst).mean, rounding, error);
}

/// True if a claim on means rests on the range that its channels declare: bets are its method.
/// Every end that a decision needs is finite, and a pilot saw few values in the outer half before
/// one, or none that vary. Two means are bet on only if both are constant.
bool bets_on_range(const Question& question, const Pilots& pilots) {
  if (question.test->method) return find_method(question, *question.test->method).is.in_range;
  const Ends needed = ends_that_decide(question);
  bool hidden = false;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* const pilot = pilot_of(side, pilots);
    if (pilot == nullptr || !side.purpose.empty() || is_recorded(side)) return false;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const ChannelData seen = pilot_channel(question, subject, channel, pilots);
      const stats::Range range = range_of(side, channel, seen.moments);
      const bool constant = is_constant(side, channel, seen.moments);
      if (!needed.are_finite(range) || !(range.low < range.high)) return false;
      // A pilot without finite values shows no mean.
      if (seen.moments.count == 0 || (seen.values.empty() && !constant)) return false;
      if (question.of_two() && !constant) return false;
      const double mean = seen.moments.mean;
      hidden = hidden || constant ||
               (needed.low && stats::may_hide_values(seen.values, mean, range.low)) ||
               (needed.high && stats::may_hide_values(seen.values, mean, range.high));
    }
  }
  return hidden;
}

// Beyond this a constant's unseen values stay undecided: they may not exist.
constexpr std::uint64_t most_for_the_unseen = 1024 * usual_secondaries;
// Fewer secondaries of a pilot do not show their law.
constexpr std::size_t fewest_of_a_law = 64;

/// The values of a secondary for planning bets. The pilot may have seen few values before an end of
/// the range, or none. Some there may be worth half of the margin, if the pilot missed them with
/// probability .01 at least. Of few secondaries only mean and deviation are known.
std::shared_ptr<const stats::ValueCells> planned_law(const PlannedChannel& planned,
                                                     const ChannelData& pilot,
                                                     std::span<const double> secondaries) {
  const double mean = pilot.moments.mean;
  const double deviation = planned.deviations[0];
  std::vector<double> values(secondaries.begin(), secondaries.end());
  // The plan reports values that are not finite.
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.size() < fewest_of_a_law) values = {mean - deviation, mean + deviation};
  auto law = std::make_shared<stats::ValueCells>(values);
  const double count = law->count();
  const double missed = std::log(100.0) / static_cast<double>(pilot.moments.count);
  for (const double end : {planned.range.low, planned.range.high}) {
    if (!std::isfinite(end) || !stats::may_hide_values(pilot.values, mean, end)) continue;
    const double worth = distance_of(planned.regions) * planned.unit / 2 / std::abs(end - mean);
    if (worth > 0) law->add(end, count * std::min(missed, worth));
  }
  return law;
}

// Barnard's maximum over the nuisance probability costs at most this (stats/means/binomial.h).
constexpr double two_sample_cost = 1.4;

bool is_quoted(const Sized& sized) {
  const MethodTraits& method = sized.test.plan.method.is;
  const PlannedChannel& channel = sized.channel;
  return method.plans != nullptr && !sized.test.question.of_two() && !channel.regions.within() &&
         (!method.in_range || channel.law) && channel.range.low < channel.range.high;
}

stats::ExactMeanPlan plan_of(const PlannedChannel& channel, const stats::ErrorRates& rates) {
  return {.range = channel.range,
          .null_mean = channel.null_value,
          .law = channel.law.get(),
          .allow = channel.regions.allow * channel.unit,
          .rates = rates};
}

/// A claim of `within` rejects each margin where theta is 0, with half of the misses.
std::optional<std::uint64_t> exact_secondaries(const TestOutcome& test,
                                               const PlannedChannel& channel,
                                               const stats::ErrorRates& rates) {
  const stats::ExactPlanning& plans = *test.plan.method.is.plans;
  if (test.question.of_two()) {
    const std::uint64_t welch = secondaries_by_t(test.plan.method, rates, channel);
    return whole_secondaries(two_sample_cost * static_cast<double>(welch));
  }
  const Regions& regions = channel.regions;
  std::uint64_t most = 0;
  for (const int side : regions.sides()) {
    double effect = side * *regions.detect * channel.unit;
    stats::ExactMeanPlan rejected = plan_of(channel, rates);
    if (regions.within()) {
      rejected.null_mean += effect;
      effect = -effect;
    }
    const auto count = regions.proof() ? plans.sample_size(rejected, effect)
                                       : stats::exact_sample_size(plans, rejected, effect);
    if (!count) return std::nullopt;
    most = std::max(most, *count);
  }
  return most;
}

/// True if every known value is one of the two ends of its range.
bool are_two_valued(const TestOutcome& test, const std::vector<Known>& channels) {
  const Question& question = test.question;
  if (question.of_two() && question.factor <= 0) return false;
  return channels.size() == question.subjects.size() * question.channel_count() &&
         std::ranges::all_of(channels, [&](const Known& known) {
           const stats::Range range =
               range_of(question.subjects[known.subject], known.channel, known.pilot.moments);
           // Rows declare no range: only 0 and 1 are surely a count of successes.
           if (known.rows && (range.low != 0 || range.high != 1)) return false;
           return test.plan.primaries[known.subject] == 1 && !known.pilot.values.empty() &&
                  std::ranges::all_of(known.pilot.values,
                                      [&](double v) { return v == range.low || v == range.high; });
         });
}

// Bets keep their values: half a gigabyte of them.
constexpr std::uint64_t most_bets = std::uint64_t{1} << 26;

/// True if bets decide within what can be kept, as far as the pilot tells.
bool can_afford_bets(TestOutcome betting, const Pilots& pilots) {
  betting.plan.method = find_method(betting.question, "betting");
  const auto size = betting.question.theta->secondaries(betting, betting.place.share, pilots);
  return size.value_or(0) <= most_bets;
}

/// Why two means cannot be compared if one is constant and its unseen values could decide; "" if
/// they can. The bound on its shift is q times the declared range to the worse side, plus rounding.
std::string unseen_could_decide(const TestOutcome& outcome, const Seen& seen) {
  const Question& question = outcome.question;
  for (std::size_t subject = 0; subject < seen.data.size() && question.of_two(); ++subject) {
    if (!is_constant(seen, subject)) continue;
    const Moments& x = seen.moments(subject);
    const Subject& side = question.subjects[subject];
    const stats::Range range = range_of(side, seen.channel, x);
    const double unseen =
        -std::expm1(std::log(outcome.share().alpha) / static_cast<double>(x.count));
    const double shift = question.factor_of(subject) *
                         (unseen * std::max({0.0, x.mean - range.low, range.high - x.mean}) +
                          rounding_of(side, seen.channel));
    const double error =
        question.factor_of(1 - subject) * seen.moments(1 - subject).standard_error();
    if (shift <= tolerated_shift * error) continue;
    return fmt::format(
        "every observation of `{}` is {:.10g}, and {}", side.estimator->name, x.mean,
        std::isfinite(shift)
            ? fmt::format("unseen values could move its mean by {:.3g}, and the comparison's "
                          "standard error is {:.3g}; take more observations",
                          shift, error)
            : "no declared range bounds how far unseen values could move its mean; declare both "
              "ends of the range, or compare the other mean with a number");
  }
  return "";
}

std::string seeds(const Question& question) {
  for (const Subject& subject : question.subjects) {
    if (is_recorded(subject)) return "if they should vary, does each have its own seed? ";
    if (subject.estimator->entry->information.says_nature) {
      return "if they should vary, does each draw its own random numbers? ";
    }
  }
  return "";
}

std::string range_advice(const Question& question) {
  return std::string(has_rows(question) ? "let a program draw the values instead of a file, and "
                                        : "") +
         "declare the range of its channel, `low` to `high`";
}

/// Verdict on a mean claim whose samples are all constant, where no declared range bounds what was
/// never seen; nullopt if one varies. A constant as claimed passes if there is no forbidden region;
/// else it is inconclusive. Any other constant is invalid.
std::optional<ConstantVerdict> judge_constant(const Seen& seen, const Regions& regions) {
  const Question& question = seen.question;
  double rounding = 0;
  for (std::size_t subject = 0; subject < seen.data.size(); ++subject) {
    if (!is_constant(seen, subject)) return {};
    rounding += question.factor_of(subject) * rounding_of(question.subjects[subject], seen.channel);
  }
  const double reference =
      question.of_two() ? question.factor * seen.moments(1).mean : seen.reference().value;
  const double difference = seen.moments(0).mean - question.offset - reference;
  const double unit = seen.relative() && reference != 0 ? std::abs(reference) : 1;
  const stats::Range theta{.low = (difference - rounding) / unit,
                           .high = (difference + rounding) / unit};
  const stats::Range claimed = regions.claimed();
  const bool as_claimed = regions.proof() ? theta.low < claimed.high && theta.high > claimed.low
                                          : theta.low <= claimed.high && theta.high >= claimed.low;
  if (as_claimed) {
    if (!regions.has_forbidden()) {
      return ConstantVerdict{
          reports::Verdict::pass,
          "every observation is the same and as claimed; unseen values are not ruled out"};
    }
    return ConstantVerdict{reports::Verdict::inconclusive,
                           "every observation is the same and as claimed, but no number of "
                           "observations bounds what unseen values could add; " +
                               range_advice(seen.question)};
  }
  return ConstantVerdict{reports::Verdict::invalid,
                         fmt::format("every observation is {:.10g}, off by {:.3g}: {}rare other "
                                     "values may be unseen and could balance this; {}",
                                     seen.moments(0).mean, difference, seeds(seen.question),
                                     range_advice(seen.question))};
}

/// The moments whose skewness counts: those of the larger sample, the pilot's or the test's own.
Moments shape_of(const TestOutcome& test, const Seen& seen, std::size_t subject) {
  const Moments& own = seen.moments(subject);
  const double averaged = seen.question.subjects[subject].averaged(test.plan.primaries[subject]);
  const auto pilot = test.plan.pilots.find({subject, seen.channel});
  const bool is_larger =
      pilot != test.plan.pilots.end() &&
      static_cast<double>(pilot->second.count) > averaged * static_cast<double>(own.count);
  return is_larger ? stats::moments_of_means(pilot->second, averaged, own.count) : own;
}

stats::Gate skewness_gate(const TestOutcome& test, const Seen& seen, double critical) {
  const bool corrects = test.plan.method.is.corrects_skewness;
  const Moments x = shape_of(test, seen, 0);
  if (seen.data.size() == 2) {
    const Moments y = shape_of(test, seen, 1);
    const double factor = seen.question.factor;
    return corrects ? stats::residual_skewness_gate(x, y, factor, critical)
                    : stats::skewness_gate(x, y, factor, critical);
  }
  if (!corrects) return stats::skewness_gate(x, critical);
  const Constant& reference = seen.reference();
  return stats::residual_skewness_gate(
      x, {reference.value + seen.question.offset, reference.standard_error}, critical);
}

std::vector<Method> methods_of_means() {
  constexpr MethodTraits corrected{.corrects_skewness = true,
                                   .over_looks = stats::LookLaw::independent_increments};
  constexpr MethodTraits of_counts{.exact = true,
                                   .of_both_ends = true,
                                   .of_observations = true,
                                   .plans = &stats::binomial_planning};
  constexpr MethodTraits of_bets{.exact = true,
                                 .in_range = true,
                                 .of_observations = true,
                                 .over_looks = stats::LookLaw::anytime_valid,
                                 .plans = &stats::betting_planning};
  constexpr MethodTraits of_batches{.of_observations = true, .of_batches = true};
  return {
      {"t", "Student's t: a mean against a number",
       [](const Question& q) { return !q.of_two() && !is_within(q); }, Keeps::moments,
       evidence_of_means<stats::mean_by_t>, of_scores},
      {"welch", "Welch's t: two means, whatever their variances",
       [](const Question& q) { return q.of_two() && !is_within(q); }, Keeps::moments,
       evidence_of_means<stats::mean_by_t>, of_scores},
      {"tost", "two one-sided t tests: a mean lies within a margin", is_within, Keeps::moments,
       evidence_of_means<stats::mean_by_t>, of_scores},
      {"skewness-corrected-t", "t or Welch, both with and without Hall's correction for skewness",
       any_question, Keeps::moments, evidence_of_means<stats::mean_by_corrected_t>, corrected},
      {"binomial", "exact: a mean of values that are the two ends of a range", any_question,
       Keeps::moments, evidence_of_means<stats::mean_by_counts>, of_counts},
      {"betting", "exact at every look: means of values in declared ranges, by bets", any_question,
       Keeps::values, evidence_of_means<stats::mean_by_bets>, of_bets},
      {"batch-means", "t of batch means: a mean of observations that depend on their neighbours",
       [](const Question& q) { return !is_within(q); }, Keeps::values,
       evidence_of_means<stats::mean_by_t>, of_batches}};
}

double unit_of(const Seen& seen) {
  const double other_mean = seen.question.of_two() ? seen.moments(1).mean : 0;
  return unit_of_theta(seen.question, seen.channel, other_mean);
}

/// theta = E x - r, or (E x - r) / |r| if margins are relative. For two estimators c E y replaces
/// r. A claimed bias is subtracted from E x.
class MeanTheta : public Theta {
 public:
  MeanTheta() : Theta({.of_moments = true, .batches_serve = true}, methods_of_means()) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override;
  const Theta* of_images() const override { return &theta_of_images(); }

  double known_size(const Question& question, const Pilots* pilots) const override {
    if (!question.of_two()) return Theta::known_size(question, pilots);
    const Subject& second = question.subjects[1];
    const Pilot* const pilot = pilots != nullptr ? pilot_of(second, *pilots) : nullptr;
    double size = 0;
    for (std::size_t i = 0; i < second.channels.size(); ++i) {
      const Channel channel = second.declared(i);
      size = std::max(size, size_beyond_error(channel.mean.value_or(0), channel.rounding));
      const Moments seen = pilot != nullptr ? pilot_channel(second, *pilot, i).moments : Moments();
      if (seen.count <= 1) continue;
      size = std::max(size, size_beyond_error(seen.mean, seen.standard_error()));
    }
    return std::abs(question.factor) * size;
  }

  bool is_relative(const Question& question, std::size_t channel) const override {
    return !has_margin(*question.test, false) &&
           (question.of_two() || question.references[channel].value != 0);
  }

  std::optional<ThetaError> error(const Seen& seen) const override {
    const Question& question = seen.question;
    const double unit = unit_of(seen);
    ThetaError error;
    double squares = 0;  // of the observations' parts of the variance
    for (std::size_t i = 0; i < seen.data.size(); ++i) {
      const Moments& x = seen.moments(i);
      const double own = question.factor_of(i) * x.standard_error() / unit;
      if (question.subjects[i].setup->observations()) {
        error.fixed = std::hypot(error.fixed, own);
      } else {
        error.drawn = std::hypot(error.drawn, own);
        if (own > 0) squares += std::pow(own, 4) * x.kurtosis() / static_cast<double>(x.count);
      }
    }
    if (squares > 0) error.effective = std::pow(error.drawn, 4) / squares;
    if (!question.references.empty()) {
      error.fixed = std::hypot(error.fixed, seen.reference().standard_error / unit);
      error.estimate = (seen.moments(0).mean - seen.reference().value) / unit;
    } else if (question.of_two()) {
      const stats::Contrast null{.scale = question.factor, .offset = question.offset};
      error.estimate = stats::contrast_of_means(seen.moments(0), seen.moments(1), null) / unit;
    }
    return error;
  }

  /// Bets take single values: what a rare one loses, they win back from each.
  bool takes_single_primaries(const Question& question, const Pilots& pilots) const override {
    return bets_on_range(question, pilots);
  }

  std::uint64_t choose(TestOutcome& test, const Pilots& pilots) const override {
    const Question& question = test.question;
    Plan& plan = test.plan;
    const std::vector<Known> channels = known_channels(test, pilots);
    bool near_normal = true;
    for (const Known& known : channels) {
      const stats::Gate gate = stats::near_normal_gate(known.pilot.moments, known.averaged);
      near_normal = near_normal && gate.state == GateState::green;
      note(plan, known, gate);
      if (!known.rows) plan.pilots[{known.subject, known.channel}] = known.pilot.moments;
    }
    if (!question.test->method) {
      if (!channels.empty() && are_two_valued(test, channels)) {
        plan.method = find_method(question, "binomial");
      } else if (bets_on_range(question, pilots) && can_afford_bets(test, pilots)) {
        plan.method = find_method(question, "betting");
      } else if (!near_normal) {
        plan.method = find_method(question, "skewness-corrected-t");
      }
    }
    // Without a size to plan, the floor is as usual as any.
    return plan.method.is.exact && has_planned_size(question) ? least_secondaries
                                                              : secondaries_of_floor(test);
  }

  std::optional<std::uint64_t> secondaries_of(const TestOutcome& test, std::size_t index,
                                              const stats::ErrorRates& rates,
                                              const Pilots& pilots) const override {
    const std::optional<PlannedChannel> channel = planned(test, index, pilots);
    if (!channel) return std::nullopt;
    if (channel->unit == 0) {
      throw std::domain_error(
          "the other mean is 0 in the pilot, and a margin in per cent of it means nothing; give "
          "the margin as a number");
    }
    if (!test.plan.method.is.plans) return secondaries_by_t(test.plan.method, rates, *channel);
    const auto count = exact_secondaries(test, *channel, rates);
    const std::uint64_t most = channel->unseen ? most_for_the_unseen : impossible_secondaries;
    return std::min(count.value_or(impossible_secondaries), most);
  }

  /// The variance is the pilot's upper limit. Returns nullopt if the channel has no spread and
  /// no range bounds what the pilot missed.
  std::optional<PlannedChannel> planned(const TestOutcome& test, std::size_t channel,
                                        const Pilots& pilots) const override {
    const Question& question = test.question;
    const Plan& plan = test.plan;
    if (!all_piloted(question, pilots)) return std::nullopt;
    PlannedChannel planned{.regions = plan.regions[channel]};
    bool constant = true;
    double other_mean = 0;
    for (std::size_t i = 0; i < question.subjects.size(); ++i) {
      const Moments moments = pilot_channel(question, i, channel, pilots).moments;
      if (i == 0) note_range(question, channel, moments, planned);
      if (i == 1) other_mean = moments.mean;
      if (is_constant(question.subjects[i], channel, moments)) continue;
      constant = false;
      const double averaged = question.subjects[i].averaged(plan.primaries[i]);
      planned.deviations[i] =
          question.factor_of(i) * std::sqrt(stats::planned_variance(moments) / averaged);
      planned.skewness[i] = question.sign_of(i) * moments.skewness() / std::sqrt(averaged);
      const auto allowance = plan.row_allowances.find({i, channel});
      if (allowance != plan.row_allowances.end()) {
        planned.deviations[i] *= std::sqrt(allowance->second);
      }
    }
    const bool bets = plan.method.is.in_range && !question.of_two();
    planned.unseen = constant && bets;
    // A mean without spread may be compared with one that has some; nothing else can be planned.
    if (constant && !bets) return std::nullopt;
    if (!question.references.empty()) {
      planned.reference_error = question.references[channel].standard_error;
    }
    planned.unit = unit_of_theta(question, channel, other_mean);
    if (bets) {
      const ChannelData pilot = pilot_channel(question, 0, channel, pilots);
      planned.law = planned_law(
          planned, pilot, as_secondaries(question.subjects[0], pilot.values, plan.primaries[0]));
    }
    return planned;
  }

  PlannedChannel observed(const Seen& seen, const Regions& regions) const override {
    const Question& question = seen.question;
    PlannedChannel observed{.regions = regions};
    for (std::size_t i = 0; i < seen.data.size(); ++i) {
      observed.deviations[i] = question.factor_of(i) * seen.moments(i).standard_deviation();
      if (!(seen.moments(i).m2 > 0)) continue;
      observed.skewness[i] = question.sign_of(i) * seen.moments(i).skewness();
    }
    if (!question.of_two()) observed.reference_error = seen.reference().standard_error;
    note_range(question, seen.channel, seen.moments(0), observed);
    if (!question.of_two() && !seen.data[0].values.empty()) {
      observed.law = std::make_shared<const stats::ValueCells>(seen.data[0].values);
    }
    observed.unit = unit_of(seen);
    return observed;
  }

  std::optional<double> detectable(const Sized& sized) const override {
    if (!sized.test.plan.method.is.exact) return Theta::detectable(sized);
    if (!is_quoted(sized)) return std::nullopt;
    double most = 0;
    for (const int side : sized.channel.regions.sides()) {
      const auto found = exact_effect(sized, side);
      if (!found) return std::nullopt;
      most = std::max(most, *found);
    }
    return most / sized.channel.unit;
  }

  bool finds_nothing(const Sized& sized) const override {
    return is_quoted(sized) && std::ranges::none_of(sized.channel.regions.sides(), [&](int side) {
             return exact_effect(sized, side).has_value();
           });
  }

  std::optional<double> power(const Sized& sized, double effect) const override {
    if (!sized.test.plan.method.is.exact) return Theta::power(sized, effect);
    if (!is_quoted(sized) || effect == 0) return std::nullopt;
    const stats::ExactMeanPlan exact = plan_of(sized.channel, sized.rates());
    const stats::ExactPlanning& plans = *sized.test.plan.method.is.plans;
    double least = 1;
    for (const int side : sized.channel.regions.sides()) {
      const double theta = side * effect * sized.channel.unit;
      least = std::min(least, plans.power(exact, sized.secondaries(), theta));
    }
    return least;
  }

  /// Rare values that were never drawn would move a mean towards an end of its range. Where that
  /// has no bound they may explain the difference: values of probability p do, if they lie
  /// difference / p from the mean. They are named up to 100 times the farthest seen, of a mean of n
  /// primaries root n times as far.
  std::string caveat(const DrawnTest& test) const override {
    const Question& question = test.outcome.question;
    if (test.outcome.verdict != reports::Verdict::fail) return "";
    const ChannelOutcome& worst = test.outcome.channels[0];
    const std::vector<ChannelData> data = data_of(test, worst.index);
    const double theta = worst.effect.estimate.value_or(0);
    const double difference =
        (std::abs(theta) - worst.regions.claimed_edge()) * unit_of({question, worst.index, data});
    for (std::size_t side = 0; side < question.compared(); ++side) {
      const Subject& subject = question.subjects[side];
      const stats::Range range = range_of(subject, worst.index, {});
      const bool upwards = (theta < 0) == (question.sign_of(side) > 0);
      const Moments& x = data[side].moments;
      const auto primaries = static_cast<double>(data[side].primaries);
      const double rarer = std::max(1.0, std::floor(static_cast<double>(x.count) * primaries / 3));
      const double far = std::sqrt(primaries) * std::max(x.maximum - x.mean, x.mean - x.minimum);
      if (std::isfinite(upwards ? range.high : range.low)) continue;
      if (difference * rarer > 100 * question.factor_of(side) * far) continue;
      return fmt::format("values rarer than 1 in {:.0f} may explain it{}", rarer,
                         is_recorded(subject) ? ""
                         : upwards            ? "; declare their `high` end"
                                              : "; declare their `low` end");
    }
    return "";
  }

  std::optional<ConstantVerdict> settled(const TestOutcome& test, const Seen& seen) const override {
    const MethodTraits& method = test.plan.method.is;
    std::optional<ConstantVerdict> verdict;
    // Bets test constants, too.
    if (!method.in_range) verdict = judge_constant(seen, test.plan.regions[seen.channel]);
    if (!verdict) verdict = Theta::settled(test, seen);
    // An exact method bounds what was never seen.
    if (verdict || method.exact) return verdict;
    const std::string lost = lost_to_rounding(seen);
    return invalid(lost.empty() ? unseen_could_decide(test, seen) : lost);
  }

  std::vector<Gate> gates(const TestOutcome& outcome, const Seen& seen, double x) const override {
    std::vector<Gate> gates;
    const std::string name = channel_suffix(seen.question, seen.channel);
    if (outcome.plan.method.is.exact) return gates;
    gates.push_back(gate_of(skewness_gate(outcome, seen, x), name));
    for (std::size_t subject = 0; subject < seen.data.size(); ++subject) {
      const Moments& moments = seen.moments(subject);
      // Two values cannot show an outlier.
      if (!(moments.m2 > 0) || moments.count <= 2) continue;
      gates.push_back(gate_of(stats::dominance_gate(moments),
                              name + " of " + seen.question.subjects[subject].estimator->name));
    }
    return gates;
  }

  std::optional<double> marked(const Seen& seen) const override {
    const Question& question = seen.question;
    return question.offset +
           (question.of_two() ? question.factor * seen.moments(1).mean : seen.reference().value);
  }

 private:
  static void note_range(const Question& question, std::size_t channel, const Moments& moments,
                         PlannedChannel& planned) {
    if (question.of_two()) return;
    planned.range = range_of(question.subjects[0], channel, moments);
    planned.null_value = question.references[channel].value + question.offset;
  }

  /// The least effect on one side; nullopt if the range ends before.
  static std::optional<double> exact_effect(const Sized& sized, int side) {
    return stats::exact_detectable(*sized.test.plan.method.is.plans,
                                   plan_of(sized.channel, sized.rates()), sized.secondaries(),
                                   side);
  }
};

/// The mean less the truth. Its margins are numbers unless one is in per cent.
class BiasTheta final : public MeanTheta {
 public:
  Question bind(const TestEntry& test, const Estimators& estimators) const override;
  bool is_relative(const Question& question, std::size_t) const override {
    return has_margin(*question.test, true);
  }
};

}  // namespace

std::string channel_suffix(const Question& question, std::size_t channel) {
  return question.channel_count() > 1 ? ", " + question.channel_name(channel) : "";
}

Question MeanTheta::bind(const TestEntry& test, const Estimators& estimators) const {
  Question question = Theta::bind(test, estimators);
  if (question.of_two() && question.subjects[1].setup->is_reference()) {
    const Subject& reference = question.subjects[1];
    require_one_size(question);
    if (reference.image) require_equal_pixels(question, reference);
    question.references = mapped(reference.declared(), [&](const Channel& channel) {
      return Constant{question.factor * channel.mean.value_or(0),
                      std::abs(question.factor) * channel.mean_error};
    });
    question.subjects.pop_back();
    question.factor = 1;
  }
  return question;
}

/// E x against reference + number. The reference is the analytic mean, or that of `reference:`.
Question BiasTheta::bind(const TestEntry& test, const Estimators& estimators) const {
  const Claim& claim = test.claim;
  if (other_side(claim) != nullptr) {
    refuse(claim.left.where,
           "a bias is compared with a number; to compare two estimators, claim their means");
  }
  const Constant number = std::get<Constant>(claim.right);
  if (claim.relation == Relation::within && claim.margin.relative && number.value != 0) {
    refuse(claim.left.where, "per cent of what? a margin on a bias other than 0 is a number");
  }
  Question question{.test = &test,
                    .theta = this,
                    .subjects = {estimates(claim.left.source, estimators)},
                    .offset = number.value};
  if (!test.reference) {
    question.references = truths_of(test, question.subjects[0], claim.left.source);
    for (Constant& truth : question.references) {
      truth.standard_error = std::hypot(truth.standard_error, number.standard_error);
    }
    return question;
  }
  if (number.standard_error > 0) {
    refuse(claim.left.where, "no method takes `+-` beside a `reference` that is sampled");
  }
  question.subjects.push_back(estimates(*test.reference, estimators));
  return question;
}

const Theta& theta_of_means() { return one<MeanTheta>(); }
const Theta& theta_of_biases() { return one<BiasTheta>(); }

}  // namespace assay::harness
