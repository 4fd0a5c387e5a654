#include "harness/method_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "harness/critical.h"
#include "harness/frozen.h"
#include "harness/image_plan.h"
#include "harness/mean_evidence.h"
#include "harness/pilot_shape.h"
#include "harness/rows.h"
#include "harness/sample_size.h"
#include "reports/number.h"
#include "stats/assumption_gates.h"
#include "stats/log_variance_level.h"
#include "stats/skewness_corrected_t.h"

namespace assay::harness {
namespace {

using stats::GateState;

// log-variance is asymptotic: on normal data its level at .001 is 1.3 times nominal here.
constexpr std::uint64_t log_variance_secondaries = 1000;
// The most that a method may ask for to be valid; as primaries beyond this cost more than they
// give.
constexpr std::uint64_t most_for_a_mean = 64 * usual_secondaries;
constexpr std::uint64_t most_for_a_variance = 1024 * usual_secondaries;
constexpr double level_factor = 1.25;

std::uint64_t whole(double count) {
  return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
}

/// The reason why a test is invalid, among its gates.
void note_too_few(Plan& plan, std::uint64_t size, std::uint64_t needed) {
  plan.gates.push_back({.name = "number of observations (limit: the fewest that keep the level)",
                        .value = static_cast<double>(size),
                        .limit = static_cast<double>(needed),
                        .state = "red"});
}

// ---- Means

/// Secondaries at which the worse tail of Student's t is right within a quarter.
std::uint64_t enough_for_t(const std::vector<Known>& channels, double critical) {
  double needed = 2;
  for (const Known& known : channels) {
    const double skewness = stats::primary_shape(known.pilot.moments).skewness;
    const double root = std::abs(skewness) * std::pow(critical, 3) / (3 * std::log(level_factor));
    const double wanted = root * root / known.averaged;
    needed = wanted <= needed ? needed : wanted;  // also where it is no number
  }
  return whole(needed);
}

/// The same of the skewness-corrected t.
std::uint64_t enough_for_corrected(const std::vector<Known>& channels, double critical) {
  std::uint64_t needed = least_secondaries;
  for (const Known& known : channels) {
    const stats::PrimaryShape primary = stats::primary_shape(known.pilot.moments);
    const stats::PrimaryShape shape{.skewness = primary.skewness / std::sqrt(known.averaged),
                                    .excess_kurtosis = primary.excess_kurtosis / known.averaged};
    const auto factor = [&](std::uint64_t count) {
      return stats::corrected_level_factor(shape, {.count = count, .critical_value = critical});
    };
    while (needed < impossible_secondaries && factor(needed) > level_factor)
      needed += needed / 4 + 1;
  }
  return needed;
}

/// Secondaries from which on what the pilot has not seen of a declared range moves the mean by a
/// tenth of its standard error at most: an event missed by N primaries has a probability of
/// ln(1 / alpha) / N or less.
std::uint64_t enough_to_see(const Question& question, const std::vector<Known>& channels,
                            double alpha) {
  constexpr double share_of_error = 0.1;
  double needed = 2;
  for (const Known& known : channels) {
    const stats::Moments& seen = known.pilot.moments;
    const stats::Range range = range_of(question, known.subject, known.channel, seen);
    const double beyond = std::max(range.high - seen.maximum, seen.minimum - range.low);
    const double root =
        std::log(1 / alpha) * beyond / (share_of_error * std::sqrt(seen.variance()));
    needed = std::max(needed, root * root / known.averaged);
  }
  return whole(needed);
}

/// Whether every value known of every subject is one of the two ends of its range.
bool are_two_valued(const Question& question, const std::vector<Known>& channels,
                    const Plan& plan) {
  if (question.of_two() && question.factor <= 0) return false;
  const auto uncertain = [](const Constant& reference) { return reference.standard_error > 0; };
  if (std::any_of(question.references.begin(), question.references.end(), uncertain)) return false;
  return channels.size() == question.subjects.size() * question.channel_count() &&
         std::all_of(channels.begin(), channels.end(), [&](const Known& known) {
           const stats::Range range =
               range_of(question, known.subject, known.channel, known.pilot.moments);
           // Rows declare no range: only 0 and 1 are surely a count of successes.
           if (known.rows && (range.low != 0 || range.high != 1)) return false;
           return plan.primaries[known.subject] == 1 && !known.pilot.values.empty() &&
                  std::all_of(known.pilot.values.begin(), known.pilot.values.end(),
                              [&](double v) { return v == range.low || v == range.high; });
         });
}

bool are_bounded(const Question& question, const std::vector<Known>& channels) {
  if (question.of_two()) return false;
  return std::all_of(channels.begin(), channels.end(), [&](const Known& known) {
    const stats::Range range = range_of(question, 0, known.channel, known.pilot.moments);
    return !known.rows && std::isfinite(range.low) && std::isfinite(range.high) &&
           question.references[known.channel].standard_error == 0;
  });
}

/// Whether "too much" can be tested exactly, whatever the law above a declared lower bound.
bool can_be_bet_on(const Question& question, const std::vector<Known>& channels) {
  if (question.of_two() || question.test->claim.relation != Relation::at_most) return false;
  return !channels.empty() &&
         std::all_of(channels.begin(), channels.end(), [&](const Known& known) {
           const stats::Range range = range_of(question, 0, known.channel, known.pilot.moments);
           return !known.rows && std::isfinite(range.low) &&
                  question.references[known.channel].standard_error == 0;
         });
}

/// How many secondaries the test has or is worth, before any look at shapes.
std::uint64_t intended(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                       std::uint64_t most, const Plan& plan) {
  if (question.test->secondaries) return std::min(*question.test->secondaries, most);
  if (has_rows(question)) return most;
  const auto planned = planned_secondaries(question, place.share, pilots, plan);
  return std::min(most, planned.value_or(usual_secondaries));
}

std::uint64_t choose_for_mean(const Question& question, const FamilyPlace& place,
                              const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::vector<Known> channels = known_channels(question, pilots, plan);
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::string heavy = too_heavy(question, channels, stats::TailClaim::mean, plan);
  const bool bounded = !channels.empty() && are_bounded(question, channels);
  const std::uint64_t to_see =
      bounded ? enough_to_see(question, channels, smallest_level(question, place)) : 2;
  const std::uint64_t for_t = std::max(to_see, enough_for_t(channels, x));
  const std::uint64_t for_corrected = std::max(to_see, enough_for_corrected(channels, x));
  const std::uint64_t size = intended(question, place, pilots, most, plan);
  const bool fixed = question.test->secondaries || size == most;
  // Where the size is open, validity may ask for more; the t test only if looks stay early.
  const std::uint64_t affordable = fixed ? size : std::min(most, std::max(size, most_for_a_mean));
  const std::uint64_t early = fixed || size <= usual_secondaries ? size : size / 4;
  std::uint64_t least = std::max(least_secondaries, for_t);
  if (question.test->method) {
    least = least_secondaries;
  } else if (are_two_valued(question, channels, plan)) {
    plan.method = find_method(question, "binomial");
    return least_secondaries;
  } else if (has_rows(question)) {
    // What more their own shape must be is the data's gates to say (rows.h).
    if (for_t > size) plan.method = find_method(question, "skewness-corrected-t");
    least = size;
  } else if (for_t > std::max(least_secondaries, early) && for_corrected < for_t &&
             for_corrected <= affordable) {
    plan.method = find_method(question, "skewness-corrected-t");
    least = for_corrected;
  } else if (for_t > affordable && bounded) {
    plan.method = find_method(question, "bounded");
    answer_red_gates(plan);
    return least_secondaries;
  } else if ((for_t > affordable || !heavy.empty()) && can_be_bet_on(question, channels)) {
    plan.method = find_method(question, "betting");
    answer_red_gates(plan);
    return least_secondaries;
  }
  for (const Known& known : channels) {
    stats::Gate gate = stats::predicted_skewness_gate(
        stats::primary_shape(known.pilot.moments), whole(known.averaged),
        {.secondaries = std::clamp(std::max(least, size), std::uint64_t{2}, affordable),
         .critical_value = x});
    // Answered by the method chosen.
    const bool answered = plan.method.name == "skewness-corrected-t";
    if (answered && gate.state == GateState::red) gate.state = GateState::amber;
    note(plan, known, gate);
  }
  if (question.test->method) return least;
  plan.invalid = heavy;
  // Red: at this size the t test's worse tail is off by more than a factor of two.
  const double red = std::pow(std::log(level_factor) / std::log(2.0), 2);
  const bool t_is_red = red * static_cast<double>(for_t) > static_cast<double>(affordable);
  if (fixed && !has_rows(question) && plan.invalid.empty() && t_is_red &&
      for_corrected > affordable) {
    note_too_few(plan, affordable, std::min(for_t, for_corrected));
    plan.invalid = fmt::format(
        "secondary estimates of this shape need about {} observations before any test of their "
        "mean "
        "keeps its level; a larger `primaries` brings them nearer to normal, or declare the range",
        reports::human(static_cast<double>(std::min(for_t, for_corrected)), 2));
  }
  return std::min(least, affordable);
}

// ---- Variances

/// The shape of a secondary by the pilot's finite values: of the others the test's own observations
/// tell, whose verdict is `error`. Nothing of fewer than two.
std::optional<stats::SixthOrderShape> secondary_shape(const Known& known) {
  std::vector<double> finite;
  std::copy_if(known.pilot.values.begin(), known.pilot.values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  if (finite.size() < 2) return {};
  return stats::averaged(stats::sixth_order_shape(finite), whole(known.averaged));
}

std::uint64_t enough_for_log_variance(const Question& question, const std::vector<Known>& channels,
                                      double critical) {
  std::uint64_t needed = log_variance_secondaries;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    std::vector<stats::SixthOrderShape> shapes;
    for (const Known& known : channels) {
      if (known.channel != channel) continue;
      if (const auto shape = secondary_shape(known)) shapes.push_back(*shape);
    }
    if (shapes.empty()) continue;
    needed = std::max(needed, shapes.size() == 1
                                  ? stats::values_for_log_variance(shapes[0], critical)
                                  : stats::values_for_log_variance(shapes[0], shapes[1], critical));
  }
  return needed;
}

std::string too_few(const Question& question, std::uint64_t needed) {
  const std::string need = reports::human(static_cast<double>(needed), 2);
  if (has_rows(question)) {
    const bool two = question.kind == QuestionKind::variance_of_two;
    const bool alone = question.kind == QuestionKind::variance_of_one;
    const std::string exact =
        two || alone ? fmt::format("; where the rows are known to be normal, `test: {}` is exact",
                                   two ? "F" : "chi-square")
                     : "";
    return fmt::format(
        "a test of the variance of rows of this shape keeps its level from about {} rows on; rows "
        "that each average several need fewer{}",
        need, exact);
  }
  return fmt::format(
      "secondary estimates of this shape need about {} observations before any test of their "
      "variance keeps its level; a larger `primaries` brings them nearer to normal unless the tail "
      "is heavy; of a heavy tail claim something of the distribution",
      need);
}

/// F and chi-square where the pilot predicts near-normal secondaries; else the logarithm of the
/// variance with its own kurtosis, from as many secondaries on as that needs; else nothing.
std::uint64_t choose_for_variance(const Question& question, const FamilyPlace& place,
                                  const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::vector<Known> channels = known_channels(question, pilots, plan);
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const stats::ShapeLimits limits = shape_limits(x);
  const std::string heavy = too_heavy(question, channels, stats::TailClaim::variance, plan);
  bool normal = channels.size() == question.subjects.size() * question.channel_count();
  for (const Known& known : channels) {
    stats::Gate gate = stats::predicted_kurtosis_gate(stats::primary_shape(known.pilot.moments),
                                                      whole(known.averaged), limits);
    normal = normal && !known.rows && gate.state == GateState::green;
    // Answered by the method chosen below.
    if (!question.test->method && gate.state == GateState::red) gate.state = GateState::amber;
    note(plan, known, gate);
  }
  if (question.test->method) return least_secondaries;
  plan.invalid = heavy;
  if (normal) return least_secondaries;
  plan.method = find_method(question, "log-variance");
  const std::uint64_t needed = enough_for_log_variance(question, channels, x);
  const std::uint64_t size = intended(question, place, pilots, most, plan);
  const bool fixed = question.test->secondaries || size == most;
  const std::uint64_t affordable = fixed ? size : std::max(size, most_for_a_variance);
  if (plan.invalid.empty() && needed > affordable) {
    note_too_few(plan, affordable, needed);
    plan.invalid = too_few(question, needed);
  }
  return std::min(needed, fixed ? size : most_for_a_variance);
}

// ---- Costs, efficiencies, total variances, slopes: one method each

/// From how many secondaries on the logarithm of every mean cost is near normal: costs may be as
/// skewed as values, and what a pilot has seen of them says so.
std::uint64_t enough_for_costs(const Question& question, const Pilots& pilots, const Plan& plan,
                               double critical) {
  std::uint64_t needed = 2;
  const CountedCost kind = question.test->cost == CostKind::samples ? samples_cost : rays_cost;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const Subject& side = question.subjects[i];
    const Pilot* pilot = pilot_of(side, pilots);
    if (pilot == nullptr || question.test->cost == CostKind::seconds) continue;
    const auto& with_cost = pilot->sums->details(side.channels[0]).with_cost;
    if (with_cost.empty() || !(with_cost[kind].cost.m2 > 0)) continue;
    const stats::Moments& cost = with_cost[kind].cost;
    const double primaries = side.averaged(plan.primaries[i]);
    const double variation = std::sqrt(cost.variance()) / cost.mean / std::sqrt(primaries);
    const double skewness = cost.skewness() / std::sqrt(primaries);
    needed = std::max(needed, stats::values_for_log_mean(
                                  {.variation = variation, .skewness = skewness}, critical));
  }
  return needed;
}

std::string too_skewed_costs(std::uint64_t needed) {
  return fmt::format(
      "costs of this shape need about {} observations before any test of their mean keeps its "
      "level; a larger `primaries` brings them nearer to normal",
      reports::human(static_cast<double>(needed), 2));
}

/// From how many secondaries on the logarithm of every variance that is part of the claim is near
/// normal.
std::uint64_t choose_for_spread(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const bool of_cost = question.kind == QuestionKind::cost;
  std::vector<Known> channels;
  if (!of_cost) channels = known_channels(question, pilots, plan);
  // A reference comes last, and only its mean is used.
  while (!channels.empty() && channels.back().subject >= question.compared()) channels.pop_back();
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::string heavy = too_heavy(question, channels, stats::TailClaim::variance, plan);
  if (question.test->method) return of_cost ? log_variance_secondaries : least_secondaries;
  plan.invalid = heavy;
  std::uint64_t needed = of_cost ? 2 : log_variance_secondaries;
  for (const Known& known : channels) {
    const auto shape = secondary_shape(known);
    if (shape) needed = std::max(needed, stats::values_for_log_variance(*shape, x));
  }
  const std::uint64_t for_costs = enough_for_costs(question, pilots, plan, x);
  needed = std::max(needed, for_costs);
  const std::uint64_t size = intended(question, place, pilots, most, plan);
  const std::uint64_t affordable =
      question.test->secondaries || size == most ? size : most_for_a_variance;
  if (plan.invalid.empty() && needed > affordable) {
    note_too_few(plan, affordable, needed);
    plan.invalid = needed == for_costs ? too_skewed_costs(needed) : too_few(question, needed);
  }
  return std::max(of_cost ? log_variance_secondaries : 2, std::min(needed, affordable));
}

/// Of means and costs at the points of a slope.
std::uint64_t choose_for_points(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, Plan& plan) {
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  return std::clamp(enough_for_t(known_channels(question, pilots, plan), x), least_secondaries,
                    most_for_a_mean);
}

std::uint64_t choose_by_shape(const Question& question, const FamilyPlace& place,
                              const Pilots& pilots, std::uint64_t most, Plan& plan) {
  if (question.kind == QuestionKind::image) {
    return choose_for_image(question, place, pilots, most, plan);
  }
  if (question.of_means()) return choose_for_mean(question, place, pilots, most, plan);
  if (question.of_variances()) return choose_for_variance(question, place, pilots, most, plan);
  if (question.of_laws()) {
    choose_for_laws(question, pilots, plan);
    return least_secondaries;
  }
  if (question.of_spread() || question.kind == QuestionKind::cost)
    return choose_for_spread(question, place, pilots, most, plan);
  return choose_for_points(question, place, pilots, plan);
}

}  // namespace

std::uint64_t choose_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::uint64_t used = std::min(most, question.test->secondaries.value_or(most));
  if (has_rows(question)) require_independent_sides(question, pilots, used);
  if (std::string reason = unusable_pilot(question, pilots); !reason.empty()) {
    plan.invalid = std::move(reason);
    return least_secondaries;
  }
  const std::uint64_t least = choose_by_shape(question, place, pilots, most, plan);
  if (has_rows(question)) judge_independence(question, pilots, used, plan);
  return least;
}

}  // namespace assay::harness
