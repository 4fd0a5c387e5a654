#include "harness/plan/sample_size.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/families/evidence_ratio.h"
#include "harness/families/mean_evidence.h"
#include "harness/families/methods.h"
#include "harness/plan/claim_size.h"
#include "harness/plan/exact_size.h"
#include "harness/plan/image_plan.h"
#include "harness/plan/law_size.h"
#include "harness/plan/look_sizes.h"
#include "harness/plan/planned_rates.h"
#include "harness/plan/rows.h"
#include "harness/theta/constant.h"
#include "harness/theta/critical.h"
#include "harness/theta/method.h"
#include "harness/theta/scale.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

// Normal quantile: one pilot in a thousand exceeds the upper limit of its variance.
constexpr double pilot_quantile = 3.09;

double upper_variance(const stats::Moments& pilot) {
  const double n = static_cast<double>(pilot.count);
  const double error = std::sqrt(std::max(0.0, pilot.kurtosis() - 1) / n);
  return pilot.variance() * std::exp(pilot_quantile * error);
}

double secondary_kurtosis(const stats::Moments& pilot, double primaries) {
  return 3 + (pilot.kurtosis() - 3) / primaries;
}

/// True for costs, efficiencies and total variances. For them 1 + the spread of their logarithm
/// stands for a kurtosis in planning.
bool has_log_spread(const Question& question) {
  return question.on_log_scale() && !question.of_variances();
}

/// The largest over the subject's channels: a sum of variances spreads no more than its worst part.
std::optional<double> pilot_log_spread(const Question& question, std::size_t subject,
                                       const Pilots& pilots, const Plan& plan) {
  const Subject& side = question.subjects[subject];
  const Pilot& pilot = *pilot_of(question, subject, pilots);
  std::optional<double> most;
  for (const std::size_t channel : side.channels) {
    const auto spread =
        planned_log_spread(question,
                           {.values = pilot.moments(channel),
                            .with_cost = pilot.sums->channels[channel].details().with_cost},
                           question.subjects[subject].averaged(plan.primaries[subject]));
    if (spread) most = std::max(most.value_or(0), *spread);
  }
  return most;
}

void note_range(const Question& question, std::size_t channel, const stats::Moments& moments,
                PlannedChannel& planned) {
  if (question.kind != QuestionKind::mean_of_one) return;
  planned.range = range_of(question, 0, channel, moments);
  planned.null_value = question.references[channel].value + question.offset;
}

// Beyond this a constant's unseen values stay undecided: they may not exist.
constexpr std::uint64_t most_for_the_unseen = 1024 * usual_secondaries;

/// The largest deviation that a constant pilot leaves open for a mean in a declared range. It is
/// the smaller of two: all values at the ends, with the claimed mean; or values that the pilot
/// missed with probability .01.
double unseen_deviation(const PlannedChannel& planned, const stats::Moments& pilot) {
  const auto [low, high] = planned.range;
  const double of_the_ends = (planned.null_value - low) * (high - planned.null_value);
  const double reach = std::max(high - pilot.mean, pilot.mean - low);
  const double unseen = std::log(100.0) / static_cast<double>(pilot.count) * reach * reach;
  return std::sqrt(std::max(0.0, std::min(of_the_ends, unseen)));
}

/// The channel as the pilot shows it. Returns nullopt if it has no spread and no range bounds what
/// it missed.
std::optional<PlannedChannel> planned_channel(const Question& question, std::size_t channel,
                                              const Pilots& pilots, const Plan& plan) {
  if (has_log_spread(question)) {
    return planned_log_channel(question, plan.regions[channel], pilots, plan);
  }
  const stats::Moments& first = pilot_channel(question, 0, channel, pilots).moments;
  PlannedChannel planned{.regions = plan.regions[channel]};
  const bool constant = is_constant(question, 0, channel, first);
  note_range(question, channel, first, planned);
  if (constant && plan.method.is.plans == stats::ExactMethod::bounded) {
    planned.standard_deviation = unseen_deviation(planned, first) /
                                 std::sqrt(question.subjects[0].averaged(plan.primaries[0]));
    planned.unseen = true;
    planned.unit = unit_of_theta(question, channel, 0);
    return planned;
  }
  // A mean without spread may be compared with one that has some; nothing else can be planned.
  if (constant && question.kind != QuestionKind::mean_of_two) return std::nullopt;
  if (!constant) {
    planned.standard_deviation =
        std::sqrt(upper_variance(first) / question.subjects[0].averaged(plan.primaries[0]));
    planned.kurtosis = secondary_kurtosis(first, question.subjects[0].averaged(plan.primaries[0]));
  }
  double other_mean = 0;
  if (question.of_two()) {
    const stats::Moments& second = pilot_channel(question, 1, channel, pilots).moments;
    other_mean = second.mean;
    if (is_constant(question, 1, channel, second)) {
      if (constant || question.kind != QuestionKind::mean_of_two) return std::nullopt;
    } else {
      planned.other_deviation =
          std::abs(question.factor) *
          std::sqrt(upper_variance(second) / question.subjects[1].averaged(plan.primaries[1]));
      planned.other_kurtosis =
          secondary_kurtosis(second, question.subjects[1].averaged(plan.primaries[1]));
    }
  } else if (!question.references.empty()) {
    planned.reference_error = question.references[channel].standard_error;
  }
  planned.unit = unit_of_theta(question, channel, other_mean);
  if (planned.unit == 0) {
    if (!planned.regions.has_margin()) return std::nullopt;
    throw std::domain_error(
        "the other mean is 0 in the pilot, and a margin in per cent of it means nothing; give the "
        "margin as a number");
  }
  return planned;
}

/// True if both samples of a comparison spread; else it is planned as one mean against a number.
bool both_spread(const Question& question, const PlannedChannel& channel) {
  return question.of_two() && channel.standard_deviation > 0 && channel.other_deviation > 0;
}

double allocation(const stats::SampleSizes& sizes) { return sizes.y / sizes.x; }

/// Size of the sample that has a spread; of the first if both have.
double size_of_the_spread(const stats::SampleSizes& sizes, const PlannedChannel& channel) {
  return channel.standard_deviation > 0 ? sizes.x : sizes.y;
}

stats::MeanPlan mean_plan(const stats::ErrorRates& rates, double allow,
                          const PlannedChannel& channel) {
  return {.standard_deviation = std::hypot(channel.standard_deviation, channel.other_deviation),
          .allow = allow * channel.unit,
          .reference_standard_error = channel.reference_error,
          .rates = rates};
}

stats::TwoMeansPlan means_plan(const stats::ErrorRates& rates, double allow,
                               const PlannedChannel& channel, double allocation = 1) {
  return {.standard_deviation_x = channel.standard_deviation,
          .standard_deviation_y = channel.other_deviation,
          .allocation = allocation,
          .allow = allow * channel.unit,
          .rates = rates};
}

std::optional<std::uint64_t> for_means(const Question& question, const stats::ErrorRates& rates,
                                       const Regions& regions, const PlannedChannel& channel) {
  const double detect = *regions.detect * channel.unit;
  if (both_spread(question, channel)) {
    return stats::welch_sample_size(means_plan(rates, regions.allow, channel), detect);
  }
  return stats::student_t_sample_size(mean_plan(rates, regions.allow, channel), detect);
}

/// Both one-sided tests at beta must reject when theta = 0, each missing with beta / 2.
std::uint64_t for_equivalence(const ErrorShare& share, const PlannedChannel& channel) {
  const double deviation = std::hypot(channel.standard_deviation, channel.other_deviation);
  const double z = stats::normal_quantile({stats::Tail::upper, std::log(share.beta)}) +
                   stats::normal_quantile({stats::Tail::upper, std::log(share.beta / 2)});
  const double wanted = channel.regions.within * channel.unit / z;  // standard error of the mean
  const double left = wanted * wanted - channel.reference_error * channel.reference_error;
  if (!(left > 0)) return impossible_secondaries;
  const double count = std::ceil(deviation * deviation / left) + 2;
  return count < 0x1p53 ? static_cast<std::uint64_t>(count) : impossible_secondaries;
}

/// Chi-square and F take flatter data for normal ones and find as little as in those, or in what
/// they allow for. A value of 1 stands for no second subject or for two values.
double kurtosis_for(const Method& method, double kurtosis, double allowed) {
  return method.is.of_normal_values && kurtosis > 1 ? std::max(3 + allowed, kurtosis)
                                                    : std::max(1.0, kurtosis);
}

stats::LogVariancePlan variance_plan(const Method& method, const stats::ErrorRates& rates,
                                     double allow, const PlannedChannel& channel,
                                     double allocation = 1) {
  const stats::ExcessKurtoses allowed = method.frozen.largest_excess_kurtosis();
  return {.kurtosis_x = kurtosis_for(method, channel.kurtosis, allowed.x),
          .kurtosis_y = kurtosis_for(method, channel.other_kurtosis, allowed.y),
          .allocation = allocation,
          .allow = std::exp(allow),
          .rates = rates};
}

std::optional<std::uint64_t> for_variances(const Method& method, const ErrorShare& share,
                                           const PlannedChannel& channel) {
  const Regions& regions = channel.regions;
  if (regions.relation == Relation::within) {
    return stats::log_variance_sample_size(
        variance_plan(method, planned_rates(share, regions), 0, channel), std::exp(regions.within));
  }
  return stats::log_variance_sample_size(
      variance_plan(method, planned_rates(share, regions), regions.allow, channel),
      std::exp(*regions.detect));
}

std::optional<std::uint64_t> one_channel(const Question& question, std::size_t index,
                                         const ErrorShare& share, const Pilots& pilots,
                                         const Plan& plan) {
  const Regions& regions = plan.regions[index];
  const bool equivalence = regions.relation == Relation::within;
  const std::optional<PlannedChannel> channel = planned_channel(question, index, pilots, plan);
  if (!channel || (!equivalence && !regions.detect)) return std::nullopt;
  std::optional<std::uint64_t> count;
  if (question.on_log_scale()) {
    count = for_variances(plan.method, share, *channel);
  } else if (plan.method.is.plans) {
    count = equivalence
                ? exact_equivalence_secondaries(question, plan, *channel, share)
                : exact_secondaries(question, plan, *channel, planned_rates(share, regions));
  } else if (equivalence) {
    count = for_equivalence(share, *channel);
  } else {
    count = for_means(question, planned_rates(share, regions), regions, *channel);
  }
  if (channel->unseen && count.value_or(impossible_secondaries) > most_for_the_unseen) return {};
  return count.value_or(impossible_secondaries);
}

/// The probability of showing `within` where theta is 0.
double equivalence_power(const Question& question, const TestSize& size, const Plan& plan,
                         const PlannedChannel& channel) {
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  if (question.on_log_scale()) {
    const double one_margin = stats::log_variance_power(
        variance_plan(plan.method, planned_rates(size.share, channel.regions), 0, channel,
                      allocation(sizes)),
        sizes.x, std::exp(channel.regions.within));
    return std::max(0.0, 2 * one_margin - 1);
  }
  // Two samples count as one of the smaller size with as uncertain a mean. The reference's error
  // does not shrink with n: as a deviation of the observations it grows.
  const double n = std::min(sizes.x, sizes.y);
  const double spread = std::hypot(channel.standard_deviation * std::sqrt(n / sizes.x),
                                   channel.other_deviation * std::sqrt(n / sizes.y),
                                   channel.reference_error * std::sqrt(n));
  return stats::equivalence_power({.standard_deviation = spread,
                                   .margin = channel.regions.within * channel.unit,
                                   .alpha = size.share.beta,
                                   .beta = size.share.beta},
                                  n, 0);
}

/// False for quantiles, slopes, images, counts of draws and methods without a formula. Numbers
/// without spread, and variances of two observations (kurtosis 1), have none either.
bool has_power(const Question& question, const Method& method, const PlannedChannel& channel) {
  using enum QuestionKind;
  if (question.kind == quantile || question.kind == slope || question.kind == image ||
      question.of_draws() || !method.is.power_is_known) {
    return false;
  }
  const bool of_spread = has_log_spread(question) || question.of_variances();
  return !of_spread || channel.kurtosis + channel.other_kurtosis > 2;
}

bool all_piloted(const Question& question, const Pilots& pilots) {
  return std::all_of(question.subjects.begin(), question.subjects.end(),
                     [&](const Subject& s) { return pilot_of(s, pilots) != nullptr; });
}

}  // namespace

std::optional<std::uint64_t> planned_secondaries(const Question& question, const ErrorShare& share,
                                                 const Pilots& pilots, const Plan& plan) {
  if (question.of_laws() && question.kind != QuestionKind::quantile) {
    return laws_secondaries(question, share, plan);
  }
  if (!all_piloted(question, pilots)) return std::nullopt;
  if (question.kind == QuestionKind::quantile) {
    return quantile_secondaries(question, share, pilots, plan);
  }
  if (question.kind == QuestionKind::image) return image_secondaries(question, share, pilots, plan);
  if (question.kind == QuestionKind::slope) {
    return slope_secondaries(question, share, pilots, plan);
  }
  std::optional<std::uint64_t> most;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const auto count = one_channel(question, channel, share, pilots, plan);
    if (count) {
      most =
          std::min(impossible_secondaries, std::max({most.value_or(0), *count, least_secondaries}));
    }
  }
  return most;
}

std::optional<PlannedChannel> planned_log_channel(const Question& question, const Regions& regions,
                                                  const Pilots& pilots, const Plan& plan) {
  if (!has_log_spread(question) || !all_piloted(question, pilots)) return std::nullopt;
  const auto first = pilot_log_spread(question, 0, pilots, plan);
  const auto second =
      question.of_two() ? pilot_log_spread(question, 1, pilots, plan) : std::optional(0.0);
  if (!first || !second || !(*first + *second > 0)) return std::nullopt;
  return PlannedChannel{.regions = regions, .kurtosis = 1 + *first, .other_kurtosis = 1 + *second};
}

std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel) {
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  const ErrorShare& share = size.share;
  const Regions& regions = channel.regions;
  if (regions.relation == Relation::within) return std::nullopt;  // it finds nothing, it shows
  if (!has_power(question, plan.method, channel)) return std::nullopt;
  const stats::ErrorRates rates = planned_rates(share, regions);
  if (plan.method.is.exact) return exact_detectable_effect(question, size, plan, channel, rates);
  double found = 0;
  if (both_spread(question, channel) && question.of_means()) {
    found = stats::welch_detectable(means_plan(rates, regions.allow, channel, allocation(sizes)),
                                    sizes.x) /
            channel.unit;
  } else if (question.of_means()) {
    found = stats::student_t_detectable(mean_plan(rates, regions.allow, channel),
                                        size_of_the_spread(sizes, channel)) /
            channel.unit;
  } else if (question.on_log_scale()) {
    found = std::log(stats::log_variance_detectable(
        variance_plan(plan.method, rates, regions.allow, channel, allocation(sizes)), sizes.x));
  } else {
    found = detectable_between_laws(question, size, plan);
  }
  if (!std::isfinite(found)) return std::nullopt;
  return found;
}

bool finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                   const PlannedChannel& channel) {
  return exact_finds_nothing(question, size, plan, channel,
                             planned_rates(size.share, channel.regions));
}

std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect) {
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  const ErrorShare& share = size.share;
  const Regions& regions = channel.regions;
  const stats::ErrorRates rates = planned_rates(share, regions);
  if (!has_power(question, plan.method, channel)) return std::nullopt;
  if (plan.method.is.exact) return exact_power_at(question, size, plan, channel, rates, effect);
  if (regions.relation == Relation::within) return equivalence_power(question, size, plan, channel);
  if (question.of_means() && !both_spread(question, channel)) {
    return stats::student_t_power(mean_plan(rates, regions.allow, channel),
                                  size_of_the_spread(sizes, channel), effect * channel.unit);
  }
  if (question.of_means()) {
    return stats::welch_power(means_plan(rates, regions.allow, channel, allocation(sizes)), sizes.x,
                              effect * channel.unit);
  }
  if (question.on_log_scale()) {
    return stats::log_variance_power(
        variance_plan(plan.method, rates, regions.allow, channel, allocation(sizes)), sizes.x,
        std::exp(effect));
  }
  return power_between_laws(question, size, plan, effect);
}

PlannedChannel observed_channel(const Question& question, const Regions& regions,
                                std::size_t channel, std::span<const ChannelData> data) {
  PlannedChannel observed{.regions = regions};
  if (has_log_spread(question)) {
    const std::optional<double> second =
        question.of_two() ? log_spread(question, 1, channel, data) : std::optional(0.0);
    observed.kurtosis = 1 + log_spread(question, 0, channel, data).value_or(0);
    observed.other_kurtosis = 1 + second.value_or(0);
    return observed;
  }
  if (!question.of_means() && !question.of_variances()) return observed;
  observed.standard_deviation = data[0].moments.standard_deviation();
  if (question.of_variances()) observed.kurtosis = data[0].moments.kurtosis();
  double other_mean = 0;
  if (question.of_two()) {
    other_mean = data[1].moments.mean;
    observed.other_deviation = std::abs(question.factor) * data[1].moments.standard_deviation();
    if (question.of_variances()) observed.other_kurtosis = data[1].moments.kurtosis();
  } else {
    observed.reference_error = question.references[channel].standard_error;
  }
  note_range(question, channel, data[0].moments, observed);
  observed.unit = unit_of_theta(question, channel, other_mean);
  return observed;
}

std::uint64_t intended_secondaries(const Question& question, const FamilyPlace& place,
                                   const Pilots& pilots, std::uint64_t most, const Plan& plan) {
  if (question.test->secondaries) return std::min(*question.test->secondaries, most);
  if (has_rows(question)) return most;
  const auto planned = planned_secondaries(question, place.share, pilots, plan);
  return std::min(most, planned.value_or(usual_secondaries));
}

}  // namespace assay::harness
