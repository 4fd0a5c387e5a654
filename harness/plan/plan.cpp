#include "harness/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "harness/plan/gate_text.h"
#include "harness/plan/look_sizes.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/rows.h"
#include "harness/plan/sample_size.h"
#include "harness/question/declared_range.h"
#include "harness/sampling/pool.h"
#include "harness/theta/ask.h"
#include "harness/theta/critical.h"
#include "harness/theta/methods.h"
#include "harness/theta/scale.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

// Half a day at 40 ns a primary.
constexpr double most_planned_primaries = 1e12;
// Ten looks cost at most twice one look's observations, unless a reference has an error.
constexpr std::uint64_t dearest_looks = 4;
// Fewest secondaries that have a spread.
constexpr std::uint64_t fewest_tested = 2;

/// The look that a budget in primaries pays for. Throws InputError if it buys fewer than two
/// secondaries of each subject.
std::uint64_t paid_for(const Question& question, const Plan& plan, std::uint64_t budget) {
  const std::uint64_t each = primaries_of_each(question, plan);
  std::uint64_t paid = budget / each;
  // Subjects without more secondaries leave their part to the others.
  while (paid >= fewest_tested) {
    const std::uint64_t next = primaries_of_look(question, plan, paid + 1);
    const std::uint64_t spent = primaries_of_look(question, plan, paid);
    if (next == spent || next > budget) return paid;
    paid += (budget - spent) / (next - spent);
  }
  throw InputError(question.test->place_of("budget"),
                   fmt::format("its budget (or its share of the suite's) of {} primaries does not "
                               "pay for two observations, the fewest that can be tested: these "
                               "take {}; give a larger budget, or fewer `primaries`",
                               budget, fewest_tested * each));
}

/// The largest look: the rows of the longest file, also for a side drawn beside it, or what a
/// budget in primaries pays for.
std::uint64_t most_available(const Question& question, const Plan& plan) {
  const std::uint64_t most =
      question.most_rows().value_or(std::numeric_limits<std::uint64_t>::max());
  const std::optional<Budget>& budget = question.test->budget;
  if (!budget || !budget->primaries) return most;
  return std::min(most, paid_for(question, plan, *budget->primaries));
}

/// Throws InputError before hours are spent on what was hardly meant.
void require_possible(const Question& question, const Plan& plan, std::uint64_t secondaries) {
  const TestEntry& test = *question.test;
  const Location& where = test.place_of(test.detect ? "detect" : "claim");
  if (secondaries >= impossible_secondaries) {
    throw InputError(where, question.theta->why_impossible(question));
  }
  const double total =
      static_cast<double>(secondaries) * static_cast<double>(primaries_of_each(question, plan));
  if (total <= most_planned_primaries) return;
  throw InputError(where, fmt::format("this claim would take about {:.1e} primaries; give a larger "
                                      "margin, or a `budget` to spend on it all the same",
                                      total));
}

stats::LookSchedule one_look(std::uint64_t secondaries) { return {{secondaries}, {1}}; }

/// One look of a method in seconds: replicates of whole blocks, with as many observations for each
/// subject.
stats::LookSchedule timed_look(const Plan& plan, std::uint64_t secondaries) {
  std::uint64_t block = 1;
  for (const std::uint64_t primaries : plan.primaries) {
    block = std::max(block, block_size_of(primaries));
  }
  const std::uint64_t unit = block * replicate_count;
  return one_look(std::max<std::uint64_t>(1, (secondaries + unit - 1) / unit) * unit);
}

/// Looks that double from the fewest meaningful up to what `detect` needs at the last look's share
/// of the errors. One look if nothing asks for a number or it is given: rows of a file,
/// `secondaries`, the classical 1000.
stats::LookSchedule plan_looks(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, const Plan& plan, std::uint64_t first) {
  const std::uint64_t most = most_available(question, plan);
  if (plan.method.keeps == Keeps::blocks) {
    if (question.test->secondaries || question.test->budget) {
      throw InputError(
          question.test->place_of(question.test->secondaries ? "secondaries" : "budget"),
          "a claim in seconds is timed on whole replicates: `secondaries` and "
          "`budget` cannot be chosen; leave them out");
    }
    const auto planned = question.theta->secondaries(question, place.share, pilots, plan);
    if (planned) require_possible(question, plan, *planned);
    return timed_look(plan, std::max(first, planned.value_or(usual_secondaries)));
  }
  if (question.test->secondaries) {
    const std::uint64_t given = std::min(*question.test->secondaries, most);
    if (!question.test->budget) require_possible(question, plan, given);
    return one_look(given);
  }
  if (has_rows(question)) return one_look(most);
  const std::optional<std::uint64_t> alone =
      question.theta->secondaries(question, place.share, pilots, plan);
  const std::uint64_t classical = question.theta->usual_size();
  if (!alone) return one_look(std::min(std::max(first, classical), most));
  if (most == std::numeric_limits<std::uint64_t>::max()) require_possible(question, plan, *alone);
  if (*alone <= first) return one_look(std::min(first, most));
  std::size_t count = std::min<std::size_t>(most_looks, 1 + std::bit_width((*alone - 1) / first));
  for (; count > 1; --count) {
    const double weight = 1 / static_cast<double>(count);
    const ErrorShare share{.alpha = place.share.alpha * weight, .beta = place.share.beta * weight};
    const std::uint64_t last =
        std::min(most, question.theta->secondaries(question, share, pilots, plan)
                           .value_or(impossible_secondaries));
    // A reference's error may put smaller shares beyond any number: try fewer looks.
    if (last > dearest_looks * *alone) continue;
    if (last <= first) return one_look(last);
    return stats::geometric_looks(
        {.first = std::max(first, (last >> (count - 1)) + 1), .last = last}, look_growth);
  }
  return one_look(std::min(*alone, most));
}

/// The look of a test that is invalid beforehand. It decides nothing; it shows the estimators'
/// data.
stats::LookSchedule look_for_its_picture(const Question& question, const Plan& plan) {
  const bool given = question.test->secondaries || has_rows(question);
  if (given || plan.method.keeps == Keeps::blocks) return plan.looks;
  return one_look(std::min(plan.looks.sizes.front(), usual_secondaries));
}

std::vector<Regions> regions_of(const Question& question) {
  const TestEntry& test = *question.test;
  std::vector<Regions> all;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    Regions regions{.relation = test.claim.relation};
    if (test.allow) regions.allow = margin_on_theta(question, channel, *test.allow);
    if (test.detect) regions.detect = margin_on_theta(question, channel, *test.detect);
    if (regions.relation == Relation::within) {
      regions.within = margin_on_theta(question, channel, test.claim.margin);
    }
    all.push_back(regions);
  }
  return all;
}

/// Names the estimator whose pilot gave a value that is not finite; "" if none did. Rows of files
/// are the test's own.
std::string not_finite_in_pilot(const Question& question, const Pilots& pilots) {
  for (const Subject& subject : question.subjects) {
    const Pilot* const pilot = pilot_of(subject, pilots);
    if (pilot == nullptr || pilot->sums->elements || subject.setup->observations()) continue;
    for (const std::size_t channel : subject.channels) {
      const ChannelSummary& seen = pilot->sums->channels[channel];
      if (seen.nonfinite == 0) continue;
      return fmt::format(
          "{} of {} observations of `{}` in the pilot are not finite, the first is observation {}",
          seen.nonfinite, pilot->sums->count, subject.estimator->name, seen.first_nonfinite);
    }
  }
  return "";
}

/// Names the estimator whose pilot broke its channel's declaration; "" if none did. Single
/// primaries show what means may hide.
std::string misdeclared(const Question& question, const Pilots& pilots) {
  for (const Subject& subject : question.subjects) {
    const Pilot* const pilot = pilot_of(subject, pilots);
    if (pilot == nullptr) continue;
    if (std::string fault = outside_of_range(subject, *pilot->sums); !fault.empty()) return fault;
  }
  return "";
}

/// Possible slip of the user: a `detect` by default, or what the family sees in the pilots.
std::string caution_of(const Question& question, const Pilots& pilots) {
  if (!question.test->detect_by_default) return question.theta->caution(question, pilots);
  return fmt::format("`detect` is {}, the default of claims about laws",
                     question.test->detect->value);
}

/// Chooses the method by the pilots' shapes, then judges the rows of files. Returns the fewest
/// secondaries that the method takes.
std::uint64_t choose_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, std::uint64_t most, Plan& plan) {
  const std::uint64_t used = largest_look(question, most);
  if (has_rows(question)) require_independent_sides(question, pilots, used);
  if (std::string reason = unusable_pilot(question, pilots); !reason.empty()) {
    plan.invalid = std::move(reason);
    return least_secondaries;
  }
  const std::uint64_t least = question.theta->choose(question, place, pilots, most, plan);
  if (has_rows(question)) judge_independence(question, pilots, used, plan);
  return least;
}

}  // namespace

std::string lack_of_density(const Question& question, const NoDensity& why) {
  return fmt::format("the density that `{}` declares cannot be had: {}",
                     question.subjects[0].estimator->name, why.what());
}

std::uint64_t primaries_of_each(const Question& question, const Plan& plan) {
  return primaries_of_look(question, plan, 1);
}

std::uint64_t primaries_of_look(const Question& question, const Plan& plan, std::uint64_t look) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < plan.primaries.size(); ++i) {
    const Subject& side = question.subjects[i];
    sum += primaries_of_observation(*side.setup, plan.primaries[i]) * side.secondaries(look);
  }
  return sum;
}

Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries) {
  const TestEntry& test = *question.test;
  Plan plan{
      .method = test.method ? find_method(question, *test.method) : methods_for(question).front(),
      .regions = regions_of(question),
      .gates_invalidate = !test.method};
  for (const Subject& subject : question.subjects) {
    const bool single = question.is().of_single_values && !subject.estimator->primaries;
    plan.primaries.push_back(single ? 1 : primaries_of(subject, primaries));
  }
  plan.pilot_error = not_finite_in_pilot(question, pilots);
  plan.error = where_pilots_stopped(question, pilots);
  if (plan.error.empty()) plan.error = misdeclared(question, pilots);
  if (!plan.error.empty()) {
    plan.looks = one_look(2);
    return plan;
  }
  try {
    question.theta->require_density(question);
    const std::uint64_t most = most_available(question, plan);
    const std::uint64_t least = choose_method(question, place, pilots, most, plan);
    plan.looks = plan_looks(question, place, pilots, plan, least);
    if (plan.invalid.empty()) plan.invalid = question.theta->too_few(question, plan);
    if (!plan.invalid.empty()) plan.looks = look_for_its_picture(question, plan);
    plan.hint += question.theta->hint(question);
    plan.caution = caution_of(question, pilots);
  } catch (const std::domain_error& error) {
    plan.looks = one_look(2);
    plan.invalid = in_words(error);
  } catch (const NoDensity& failure) {
    plan.looks = one_look(2);
    plan.error = lack_of_density(question, failure);
  }
  return plan;
}

}  // namespace assay::harness
