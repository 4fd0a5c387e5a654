#include "harness/plan/sizes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/gates/assumption_gates.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// Chi-square and F take flatter data for normal ones and find as little as in those.
double deviation_for(const Method& method, double deviation) {
  return method.is.of_normal_values && deviation > 0 ? std::max(std::numbers::sqrt2, deviation)
                                                     : deviation;
}

/// The plan for subjects of equal sizes.
stats::MeanPlan mean_plan(const Method& method, const stats::ErrorRates& rates,
                          const PlannedChannel& channel, int side) {
  const int corrected = method.is.corrects_skewness ? side : 0;
  return {.standard_deviation = deviation_for(method, channel.deviations[0]),
          .other_standard_deviation = deviation_for(method, channel.deviations[1]),
          .skewness = corrected * channel.skewness[0],
          .other_skewness = corrected * channel.skewness[1],
          .allow = channel.regions.allow * channel.unit,
          .reference_standard_error = channel.reference_error,
          .rates = rates};
}

}  // namespace

bool has_planned_size(const Question& question) {
  return question.test->detect || question.test->claim.relation == Relation::within;
}

double critical_value(double alpha, bool two_sided) {
  return stats::upper_normal_quantile(two_sided ? alpha / 2 : alpha);
}

std::size_t most_looks(const FamilyPlace& place) { return place.in_seconds ? 40 : 16; }

double kurtosis_limit(const Question& question, const FamilyPlace& place) {
  const bool planned = has_planned_size(question) && !question.test->secondaries;
  const double looks = planned ? static_cast<double>(most_looks(place)) : 1;
  const double critical =
      critical_value(place.share.alpha / looks, is_two_sided(question.test->claim.relation));
  return stats::kurtosis_limit_at(critical);
}

stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions) {
  if (regions.relation == Relation::within) {
    return {.alpha = share.beta, .beta = share.beta / 2, .two_sided = false};
  }
  if (regions.proof()) return {.alpha = share.beta, .beta = share.beta, .two_sided = false};
  return {.alpha = share.alpha, .beta = share.beta, .two_sided = regions.two_sided()};
}

stats::MeanPlan mean_plan(const Sized& sized, int side) {
  stats::MeanPlan plan = mean_plan(sized.test.plan.method, sized.rates(), sized.channel, side);
  plan.allocation = sized.sizes().y / sized.sizes().x;
  return plan;
}

std::uint64_t secondaries_by_t(const Method& method, const stats::ErrorRates& rates,
                               const PlannedChannel& channel) {
  const double detect = *channel.regions.detect * channel.unit;
  return stats::student_t_sample_size(mean_plan(method, rates, channel, 1), detect)
      .value_or(impossible_secondaries);
}

std::uint64_t secondaries_of_floor(const TestOutcome& test) {
  std::uint64_t floor = least_secondaries;
  for (std::size_t i = 0; i < test.question.subjects.size(); ++i) {
    const Setup& setup = *test.question.subjects[i].setup;
    if (setup.observations() || setup.image() || setup.keeps_files()) continue;
    const std::uint64_t each = std::max<std::uint64_t>(1, test.plan.primaries[i]);
    floor = std::max(floor, (floor_of_evidence + each - 1) / each);
  }
  return floor;
}

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share) {
  return stats::one_look(secondaries, share.alpha, share.beta);
}

std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < test.plan.primaries.size(); ++i) {
    const Subject& side = test.question.subjects[i];
    sum += primaries_of_observation(*side.setup, test.plan.primaries[i]) * side.secondaries(look);
  }
  return sum;
}

std::uint64_t whole_secondaries(double count) {
  return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
}

bool all_piloted(const Question& question, const Pilots& pilots) {
  return std::ranges::all_of(question.subjects,
                             [&](const Subject& s) { return pilot_of(s, pilots) != nullptr; });
}

double distance_of(const Regions& regions) {
  return regions.detect ? *regions.detect - regions.allow : 0;
}

stats::ErrorRates Sized::rates() const { return planned_rates(size.share, channel.regions); }

stats::SampleSizes Sized::sizes() const {
  const auto taken = [&](std::size_t subject) {
    return static_cast<double>(test.question.subjects[subject].secondaries(size.secondaries));
  };
  return {.x = taken(0), .y = taken(test.question.of_two() ? 1 : 0)};
}

std::optional<double> detectable_effect(const Sized& sized) {
  const std::optional<double> found = sized.test.question.theta->detectable(sized);
  return found && std::isfinite(*found) ? found : std::nullopt;
}

}  // namespace assay::harness
