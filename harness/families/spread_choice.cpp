#include "harness/families/spread_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "harness/families/costs.h"
#include "harness/plan/critical.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/rows.h"
#include "harness/plan/sample_size.h"
#include "harness/plan/secondaries.h"
#include "harness/sampling/group_variance.h"
#include "harness/theta/ask.h"
#include "harness/theta/methods.h"
#include "reports/words/number.h"
#include "stats/gates/assumption_gates.h"
#include "stats/gates/log_variance_level.h"

namespace assay::harness {
namespace {

// Fewest secondaries of log-variance, which is asymptotic.
constexpr std::uint64_t log_variance_secondaries = 1000;
// The most that a method may ask for to be valid.
constexpr std::uint64_t most_for_a_variance = 1024 * usual_secondaries;

/// Shape of a secondary by the pilot's finite values. The test's own observations report others as
/// `error`. Returns nullopt for too few rows.
std::optional<stats::SixthOrderShape> secondary_shape(const Known& known) {
  std::vector<double> finite;
  std::copy_if(known.pilot.values.begin(), known.pilot.values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  if (finite.size() < fewest_in_order) return {};
  return stats::averaged(stats::sixth_order_shape(finite), whole_secondaries(known.averaged));
}

/// Observations of the subject with fewest, if one with `times` as many needs `secondaries`.
std::uint64_t of_the_fewest(std::uint64_t secondaries, double times) {
  return whole_secondaries(static_cast<double>(secondaries) / times);
}

std::uint64_t enough_for_log_variance(const Question& question, const std::vector<Known>& channels,
                                      double critical) {
  std::uint64_t needed = log_variance_secondaries;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    std::vector<stats::SixthOrderShape> shapes;
    std::vector<double> times;
    for (const Known& known : channels) {
      if (known.channel != channel) continue;
      const auto shape = secondary_shape(known);
      if (!shape) continue;
      shapes.push_back(*shape);
      times.push_back(known.times);
    }
    if (shapes.empty()) continue;
    const std::uint64_t of_first =
        shapes.size() == 1 ? stats::values_for_log_variance(shapes[0], critical)
                           : stats::values_for_log_variance(shapes[0], shapes[1], critical,
                                                            level_factor, times[1] / times[0]);
    needed = std::max(needed, of_the_fewest(of_first, times[0]));
  }
  return needed;
}

/// `given`: how many there are.
std::string too_few(const Question& question, std::uint64_t given, std::uint64_t needed) {
  const std::string need = reports::human(static_cast<double>(needed), 2);
  // Every shape needs log_variance_secondaries.
  const bool by_shape = needed > log_variance_secondaries;
  if (has_rows(question)) {
    std::string exact;
    for (const Method& method : methods_for(question)) {
      if (!method.is.of_normal_values) continue;
      exact = ", or, if they are normal, add " + written_key(*question.test, "test", method.name);
    }
    return fmt::format(
        "{} row{} too few: a variance of values of this shape takes about {}; "
        "give more{}{}",
        given, given == 1 ? " is" : "s are", need,
        by_shape ? ", or rows that each average several" : "", exact);
  }
  if (!by_shape) {
    return fmt::format("a test of this variance keeps its level from {} observations on", need);
  }
  return fmt::format(
      "secondary estimates of this shape need about {} observations before any test of their "
      "variance keeps its level; a larger `primaries` brings them nearer to normal unless the tail "
      "is heavy; of a heavy tail claim something of the distribution",
      need);
}

/// Secondaries from which the logarithm of every mean cost is near normal. Costs may be as skewed
/// as values.
std::uint64_t enough_for_costs(const Question& question, const Pilots& pilots, std::uint64_t look,
                               const Plan& plan, double critical) {
  std::uint64_t needed = 2;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const Subject& side = question.subjects[i];
    const Pilot* pilot = pilot_of(question, i, pilots);
    if (pilot == nullptr || question.test->cost == CostKind::seconds) continue;
    const auto& with_cost = pilot->sums->details(side.channels[0]).with_cost;
    if (with_cost.empty()) continue;
    const stats::Moments& cost = by_its_cost(question, with_cost).cost;
    if (!(cost.m2 > 0)) continue;
    const double primaries = side.averaged(plan.primaries[i]);
    const double variation = std::sqrt(cost.variance()) / cost.mean / std::sqrt(primaries);
    const double skewness = cost.skewness() / std::sqrt(primaries);
    const std::uint64_t values =
        stats::values_for_log_mean({.variation = variation, .skewness = skewness}, critical);
    needed = std::max(needed, of_the_fewest(values, times_the_fewest(question, i, look)));
  }
  return needed;
}

/// Shape of the variances of groups of secondaries, summed over the channels, from the pilot's
/// values. Returns nullopt if none are kept, as of many channels, or too few. Secondaries of many
/// primaries have few, and are near normal.
std::optional<stats::PositiveShape> group_shape(const Question& question, std::size_t subject,
                                                const Pilots& pilots, const Plan& plan) {
  constexpr std::uint64_t fewest_groups = 64;
  const Subject& side = question.subjects[subject];
  const Pilot* const drawn = pilot_of(question, subject, pilots);
  if (drawn == nullptr || side.channels.size() > most_kept_channels) return {};
  std::vector<std::vector<double>> secondaries;
  std::vector<std::size_t> channels;
  for (std::size_t i = 0; i < side.channels.size(); ++i) {
    secondaries.push_back(
        as_secondaries(side, pilot_channel(side, *drawn, i).values, plan.primaries[subject]));
    if (secondaries[i].size() != secondaries[0].size()) return {};
    channels.push_back(i);
  }
  GroupVariance groups(channels);
  stats::Moments variances;
  std::vector<double> secondary(channels.size());
  for (std::size_t row = 0; row < secondaries[0].size(); ++row) {
    for (const std::size_t channel : channels) secondary[channel] = secondaries[channel][row];
    if (const auto variance = groups.add(secondary)) variances.add(*variance);
  }
  if (variances.count < fewest_groups || !(variances.m2 > 0)) return {};
  return stats::PositiveShape{.variation = variances.standard_deviation() / variances.mean,
                              .skewness = variances.skewness()};
}

/// Secondaries from which the logarithm of the groups' mean variance is near normal.
std::uint64_t enough_for_groups(const Question& question, const Pilots& pilots, std::uint64_t look,
                                const Plan& plan, double critical) {
  std::uint64_t needed = 2;
  if (plan.method.keeps != Keeps::group_variances) return needed;
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    if (const auto shape = group_shape(question, subject, pilots, plan)) {
      const std::uint64_t values = variance_group * stats::values_for_log_mean(*shape, critical);
      needed = std::max(needed, of_the_fewest(values, times_the_fewest(question, subject, look)));
    }
  }
  return needed;
}

std::string too_skewed_costs(std::uint64_t needed) {
  return fmt::format(
      "costs of this shape need about {} observations before any test of their mean keeps its "
      "level; a larger `primaries` brings them nearer to normal",
      reports::human(static_cast<double>(needed), 2));
}

/// The most secondaries of each subject: a fixed number or all, else what the claim is worth or a
/// method may ask for.
std::uint64_t affordable_secondaries(const Question& question, const FamilyPlace& place,
                                     const Pilots& pilots, std::uint64_t most, const Plan& plan) {
  const std::uint64_t size = intended_secondaries(question, place, pilots, most, plan);
  const bool fixed = question.test->secondaries || size == most;
  return fixed ? fewest_secondaries(question, size) : std::max(size, most_for_a_variance);
}

/// A forced method runs from the fewest secondaries on; a red gate says if its level is off.
std::uint64_t as_forced(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                        std::uint64_t most, std::uint64_t needed, std::uint64_t fewest,
                        Plan& plan) {
  const std::uint64_t intended =
      fewest_secondaries(question, intended_secondaries(question, place, pilots, most, plan));
  const std::uint64_t size = question.test->secondaries ? intended : std::max(intended, fewest);
  if (needed > size) note_too_few(plan, size, needed);
  return fewest;
}

/// True if F and chi-square keep their level. Notes the gates; an unforced test answers a red one
/// by another method.
bool are_near_normal(const Question& question, const std::vector<Known>& channels, double critical,
                     Plan& plan) {
  const stats::ShapeLimits limits = shape_limits(critical);
  bool normal = channels.size() == question.subjects.size() * question.channel_count();
  for (const Known& known : channels) {
    stats::Gate gate = stats::predicted_kurtosis_gate(stats::primary_shape(known.pilot.moments),
                                                      whole_secondaries(known.averaged), limits);
    normal = normal && !known.rows && gate.state == stats::GateState::green;
    const bool answered = !question.test->method && gate.state == stats::GateState::red;
    if (answered) gate.state = stats::GateState::amber;
    note(plan, known, gate);
  }
  return normal;
}

/// True if the pilot leaves room for near-normal data: no kurtosis has a lower limit beyond the
/// bound.
bool may_be_near_normal(const Question& question, const std::vector<Known>& channels,
                        double critical) {
  const double limit = shape_limits(critical).excess_kurtosis;
  return channels.size() == question.subjects.size() * question.channel_count() &&
         std::ranges::all_of(channels, [&](const Known& known) {
           return !known.rows && known.pilot.moments.m2 > 0 &&
                  stats::kurtosis_gate(known.pilot.moments).low <= limit * known.averaged;
         });
}

/// Chi-square and F allow for a kurtosis beyond the bound that the pilot cannot exclude. A forced
/// one gets no allowance.
void allow_for_kurtosis(const Question& question, const std::vector<Known>& channels,
                        double critical, Plan& plan) {
  const double limit = shape_limits(critical).excess_kurtosis;
  std::vector<stats::ExcessKurtoses> allowed(question.channel_count());
  for (const Known& known : channels) {
    constexpr std::uint64_t fewest_with_kurtosis = 4;
    if (known.pilot.moments.count < fewest_with_kurtosis) continue;
    const double upper = stats::kurtosis_upper_limit(known.pilot.moments) / known.averaged;
    stats::ExcessKurtoses& mine = allowed[known.channel];
    (known.subject == 0 ? mine.x : mine.y) = upper > limit ? upper : 0;
  }
  plan.method.frozen.excess_kurtoses = std::move(allowed);
}

}  // namespace

std::uint64_t choose_for_variance(const Question& question, const FamilyPlace& place,
                                  const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::vector<Known> channels =
      known_channels(question, pilots, largest_look(question, most), plan);
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::string heavy = too_heavy(question, channels, plan);
  const bool forced = question.test->method.has_value();
  if (forced && !plan.method.is.of_normal_values) {
    const std::uint64_t needed = enough_for_log_variance(question, channels, x);
    return as_forced(question, place, pilots, most, needed, least_secondaries, plan);
  }
  const bool normal = are_near_normal(question, channels, x, plan);
  if (forced) return least_secondaries;
  plan.invalid = heavy;
  if (normal) {
    allow_for_kurtosis(question, channels, x, plan);
    return least_secondaries;
  }
  const std::uint64_t needed = enough_for_log_variance(question, channels, x);
  const std::uint64_t affordable = affordable_secondaries(question, place, pilots, most, plan);
  // Too few for another test. The exact one stands if the pilot does not contradict it, with amber
  // gates: small pilots would turn away many normal laws.
  const bool too_few_for_others = plan.invalid.empty() && needed > affordable;
  if (too_few_for_others && may_be_near_normal(question, channels, x)) {
    allow_for_kurtosis(question, channels, x, plan);
    return least_secondaries;
  }
  plan.method = find_method(question, "log-variance");
  if (plan.invalid.empty() && needed > affordable) {
    note_too_few(plan, affordable, needed);
    plan.invalid = too_few(question, affordable, needed);
  }
  return std::min(needed, affordable);
}

std::uint64_t choose_for_spread(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::uint64_t look = largest_look(question, most);
  std::vector<Known> channels = known_channels(question, pilots, look, plan);
  // A reference comes last, and only its mean is used.
  while (!channels.empty() && channels.back().subject >= question.compared()) channels.pop_back();
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::string heavy = too_heavy(question, channels, plan);
  std::uint64_t needed = log_variance_secondaries;
  for (const Known& known : channels) {
    const auto shape = secondary_shape(known);
    if (!shape) continue;
    const std::uint64_t values = stats::values_for_log_variance(*shape, x);
    needed = std::max(needed, of_the_fewest(values, known.times));
  }
  const std::uint64_t for_costs = enough_for_costs(question, pilots, look, plan, x);
  needed = std::max({needed, for_costs, enough_for_groups(question, pilots, look, plan, x)});
  if (question.test->method) {
    return as_forced(question, place, pilots, most, needed, least_secondaries, plan);
  }
  plan.invalid = heavy;
  const std::uint64_t affordable = affordable_secondaries(question, place, pilots, most, plan);
  if (plan.invalid.empty() && needed > affordable) {
    note_too_few(plan, affordable, needed);
    plan.invalid =
        needed == for_costs ? too_skewed_costs(needed) : too_few(question, affordable, needed);
  }
  return std::min(needed, affordable);
}

std::uint64_t choose_for_costs(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::uint64_t needed =
      enough_for_costs(question, pilots, largest_look(question, most), plan, x);
  if (question.test->method) {
    return as_forced(question, place, pilots, most, needed, log_variance_secondaries, plan);
  }
  const std::uint64_t affordable = affordable_secondaries(question, place, pilots, most, plan);
  if (needed > affordable) {
    note_too_few(plan, affordable, needed);
    plan.invalid = too_skewed_costs(needed);
  }
  return std::max(log_variance_secondaries, std::min(needed, affordable));
}

}  // namespace assay::harness
