#include "harness/plan/method_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/families/mean_evidence.h"
#include "harness/families/methods.h"
#include "harness/plan/frozen.h"
#include "harness/plan/image_plan.h"
#include "harness/plan/look_sizes.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/rows.h"
#include "harness/plan/sample_size.h"
#include "harness/plan/spread_choice.h"
#include "harness/theta/constant.h"
#include "harness/theta/critical.h"
#include "reports/words/number.h"
#include "stats/gates/assumption_gates.h"
#include "stats/means/skewness_corrected_t.h"

namespace assay::harness {
namespace {

using stats::GateState;

// The most secondaries that a method of means may ask for; more cost more than they give.
constexpr std::uint64_t most_for_a_mean = 64 * usual_secondaries;
constexpr double level_factor = 1.25;

/// Secondaries, of the subject with fewest, that keep the worse tail of Student's t right within a
/// quarter.
std::uint64_t enough_for_t(const std::vector<Known>& channels, double critical) {
  double needed = 2;
  for (const Known& known : channels) {
    const double skewness = stats::primary_shape(known.pilot.moments).skewness;
    const double root = std::abs(skewness) * std::pow(critical, 3) / (3 * std::log(level_factor));
    const double wanted = root * root / known.averaged / known.times;
    needed = wanted <= needed ? needed : wanted;  // also if it is NaN
  }
  return whole_secondaries(needed);
}

/// The same for the skewness-corrected t.
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

/// Secondaries from which unseen values of a declared range move the mean by a tenth of its
/// standard error at most. An event that N primaries missed has probability ln(1 / alpha) / N at
/// most.
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
  return whole_secondaries(needed);
}

/// True if every known value is one of the two ends of its range.
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

/// True if the range is finite on both sides and the reference exact.
bool in_known_bounds(const Question& question, std::size_t channel, const stats::Moments& seen) {
  const stats::Range range = range_of(question, 0, channel, seen);
  return std::isfinite(range.low) && std::isfinite(range.high) &&
         question.references[channel].standard_error == 0;
}

bool are_bounded(const Question& question, const std::vector<Known>& channels) {
  if (question.of_two()) return false;
  return std::all_of(channels.begin(), channels.end(), [&](const Known& known) {
    return !known.rows && in_known_bounds(question, known.channel, known.pilot.moments);
  });
}

/// True if "too much" has an exact test, which takes a declared lower bound and no other.
bool can_be_bet_on(const Question& question, const std::vector<Known>& channels) {
  if (question.of_two() || question.test->claim.relation != Relation::at_most) return false;
  return !channels.empty() &&
         std::all_of(channels.begin(), channels.end(), [&](const Known& known) {
           const stats::Range range = range_of(question, 0, known.channel, known.pilot.moments);
           return !known.rows && std::isfinite(range.low) &&
                  question.references[known.channel].standard_error == 0;
         });
}

/// True if the pilot saw a single value of means in declared ranges: only unseen values are left to
/// test.
bool are_unseen_in_ranges(const Question& question, const Pilots& pilots) {
  if (question.kind != QuestionKind::mean_of_one || question.subjects.empty()) return false;
  const Pilot* const pilot = pilot_of(question, 0, pilots);
  if (pilot == nullptr || has_rows(question)) return false;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const stats::Moments& seen = pilot_channel(question, 0, channel, pilots).moments;
    const stats::Range range = range_of(question, 0, channel, seen);
    if (!is_constant(question, 0, channel, seen) || !(range.low < range.high) ||
        !in_known_bounds(question, channel, seen)) {
      return false;
    }
  }
  return true;
}

std::uint64_t choose_for_mean(const Question& question, const FamilyPlace& place,
                              const Pilots& pilots, std::uint64_t most, Plan& plan) {
  if (!question.test->method && are_unseen_in_ranges(question, pilots)) {
    plan.method = find_method(question, "bounded");
    return least_secondaries;
  }
  const std::vector<Known> channels =
      known_channels(question, pilots, largest_look(question, most), plan);
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const std::string heavy = too_heavy(question, channels, stats::TailClaim::mean, plan);
  const bool bounded = !channels.empty() && are_bounded(question, channels);
  const std::uint64_t to_see =
      bounded ? enough_to_see(question, channels, smallest_level(question, place)) : 2;
  const std::uint64_t for_t = std::max(to_see, enough_for_t(channels, x));
  const std::uint64_t for_corrected = std::max(to_see, enough_for_corrected(channels, x));
  const std::uint64_t size = intended_secondaries(question, place, pilots, most, plan);
  const bool fixed = question.test->secondaries || size == most;
  // If the size is open, validity may ask for more; the t test only if looks stay early.
  const std::uint64_t affordable = fixed ? size : std::min(most, std::max(size, most_for_a_mean));
  const std::uint64_t early = fixed || size <= usual_secondaries ? size : size / 4;
  std::uint64_t least = std::max(least_secondaries, for_t);
  if (question.test->method) {
    least = least_secondaries;
  } else if (are_two_valued(question, channels, plan)) {
    plan.method = find_method(question, "binomial");
    return least_secondaries;
  } else if (has_rows(question)) {
    // The data's own gates judge their shape further (rows.h).
    if (for_t > fewest_secondaries(question, size))
      plan.method = find_method(question, "skewness-corrected-t");
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
        stats::primary_shape(known.pilot.moments), whole_secondaries(known.averaged),
        {.secondaries = std::clamp(std::max(least, size), std::uint64_t{2}, affordable),
         .critical_value = x});
    // The chosen method answers it.
    const bool answered = plan.method.is.corrects_skewness;
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

/// Chooses for means and costs at the points of a slope.
std::uint64_t choose_for_points(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const double x = critical_value(smallest_level(question, place), two_sided(question));
  const auto channels = known_channels(question, pilots, largest_look(question, most), plan);
  return std::clamp(enough_for_t(channels, x), least_secondaries, most_for_a_mean);
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
  if (question.kind == QuestionKind::cost) {
    return choose_for_costs(question, place, pilots, most, plan);
  }
  if (question.of_spread()) return choose_for_spread(question, place, pilots, most, plan);
  return choose_for_points(question, place, pilots, most, plan);
}

}  // namespace

std::uint64_t choose_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::uint64_t used = largest_look(question, most);
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
