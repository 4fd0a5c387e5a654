#include "harness/plan/looks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/plan/sizes.h"
#include "harness/sampling/pool.h"

namespace assay::harness {
namespace {

// Half a day at 40 ns a primary.
constexpr double most_planned_primaries = 1e12;
// Looks cost at most twice one look's observations, unless a reference has an error.
constexpr std::uint64_t dearest_looks = 4;
// A test may draw so many times its first look, although it needs less, while a gate is red.
constexpr std::uint64_t waiting_looks = 4;
// The last look may be put off to so many times its size.
constexpr std::uint64_t most_postponed = 64;
// Fewest secondaries that have a spread.
constexpr std::uint64_t fewest_tested = 2;

/// The look that a budget in primaries pays for beside the pilots. Throws InputError if it buys
/// fewer than two secondaries of each subject.
std::uint64_t paid_for(const TestOutcome& test, std::uint64_t whole, std::uint64_t pilots) {
  const std::uint64_t each = primaries_of_look(test, 1);
  const std::uint64_t budget = whole - std::min(whole, pilots);
  std::uint64_t paid = budget / each;
  // Subjects without more secondaries leave their part to the others.
  while (paid >= fewest_tested) {
    const std::uint64_t next = primaries_of_look(test, paid + 1);
    const std::uint64_t spent = primaries_of_look(test, paid);
    if (next == spent || next > budget) return paid;
    paid += (budget - spent) / (next - spent);
  }
  refuse(
      test.question.test->place_of("budget"),
      "its budget (or its share of the suite's) of {} primaries does not pay for a pilot and two "
      "observations, the fewest that can be tested: the two take {}; give a larger budget, or "
      "fewer `primaries`",
      whole, fewest_tested * each);
}

/// Throws InputError before hours are spent on what was hardly meant.
void require_possible(const TestOutcome& test, std::uint64_t secondaries) {
  const Question& question = test.question;
  const Location& where = question.test->place_of(question.test->detect ? "detect" : "claim");
  if (secondaries >= impossible_secondaries) {
    refuse(where, question.theta->why_impossible(question));
  }
  const double total =
      static_cast<double>(secondaries) * static_cast<double>(primaries_of_look(test, 1));
  if (total <= most_planned_primaries) return;
  refuse(where,
         "this claim would take about {:.1e} primaries; give a larger margin, or a `budget` to "
         "spend on it all the same",
         total);
}

/// One look of a method in seconds: replicates of whole blocks, with as many observations for each
/// subject.
stats::LookSchedule timed_look(const TestOutcome& test, std::uint64_t secondaries) {
  std::uint64_t block = 1;
  for (const std::uint64_t primaries : test.plan.primaries) {
    block = std::max(block, block_size_of(primaries));
  }
  const std::uint64_t unit = block * replicate_count;
  return one_look(std::max<std::uint64_t>(1, (secondaries + unit - 1) / unit) * unit,
                  test.place.share);
}

/// Sizes up to `last` in at most `count` looks.
std::vector<std::uint64_t> sizes_up_to(std::uint64_t last, std::uint64_t first, double growth,
                                       std::size_t count) {
  const double shrunk = static_cast<double>(last) / std::pow(growth, count - 1);
  const auto earliest = static_cast<std::uint64_t>(std::ceil(shrunk));
  return stats::geometric_sizes({.first = std::max(first, earliest), .last = last}, growth);
}

}  // namespace

std::uint64_t most_available(const TestOutcome& test, const Pilots& pilots) {
  const std::uint64_t most =
      test.question.most_rows().value_or(std::numeric_limits<std::uint64_t>::max());
  const std::optional<Budget>& budget = test.question.test->budget;
  if (!budget || !budget->primaries) return most;
  return std::min(most,
                  paid_for(test, *budget->primaries, primaries_of_pilots(test.question, pilots)));
}

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share) {
  return {.sizes = {secondaries}, .alpha = {share.alpha}, .beta = {share.beta}};
}

void require_free_size(const TestOutcome& test) {
  const TestEntry& entry = *test.question.test;
  if (test.plan.method.keeps != Keeps::blocks || (!entry.secondaries && !entry.budget)) return;
  refuse(entry.place_of(entry.secondaries ? "secondaries" : "budget"),
         "a claim in seconds is timed on whole replicates: `secondaries` and `budget` cannot be "
         "chosen; leave them out");
}

stats::LookSchedule plan_looks(const TestOutcome& test, const Pilots& pilots,
                               const stats::LookRange& range) {
  const auto [first, most] = range;
  const Question& question = test.question;
  const TestEntry& entry = *question.test;
  const ErrorShare& whole = test.place.share;
  if (test.plan.method.keeps == Keeps::blocks) {
    const auto planned = question.theta->secondaries(test, whole, pilots);
    if (planned) require_possible(test, *planned);
    return timed_look(test, std::max(first, planned.value_or(usual_secondaries)));
  }
  if (entry.secondaries) {
    const std::uint64_t given = std::min(*entry.secondaries, most);
    if (!entry.budget) require_possible(test, given);
    return one_look(given, whole);
  }
  if (has_rows(question)) return one_look(most, whole);
  const std::optional<std::uint64_t> alone = question.theta->secondaries(test, whole, pilots);
  const std::uint64_t classical = question.theta->usual_size();
  if (!alone) return one_look(std::min(std::max(first, classical), most), whole);
  if (most == std::numeric_limits<std::uint64_t>::max()) require_possible(test, *alone);
  const stats::LookLaw law = test.plan.method.is.over_looks;
  const bool may_wait = law == stats::LookLaw::independent_increments;
  const std::uint64_t least = may_wait ? waiting_looks * first : first;
  const std::uint64_t needed = std::max(*alone, least);
  if (needed <= first) return one_look(std::min(first, most), whole);
  // Each look pays for itself in a union bound, and costs next to nothing otherwise.
  const bool unknown = law == stats::LookLaw::unknown;
  const double growth = unknown ? 2 : std::numbers::sqrt2;
  const std::size_t most_of_them = unknown ? 10 : most_looks(test.place);
  const stats::ErrorRates errors{
      .alpha = whole.alpha, .beta = whole.beta, .two_sided = is_two_sided(entry.claim.relation)};
  const std::size_t sizes = stats::geometric_sizes({.first = first, .last = needed}, growth).size();
  for (std::size_t count = std::min(most_of_them, sizes); count > 1; --count) {
    const stats::LookSchedule trial =
        stats::schedule_looks(sizes_up_to(needed, first, growth, count), law, errors);
    const ErrorShare share{.alpha = trial.alpha.back(), .beta = trial.beta.back()};
    const std::uint64_t last =
        std::min(most, std::max(least, question.theta->secondaries(test, share, pilots)
                                           .value_or(impossible_secondaries)));
    // A reference's error may put smaller levels beyond any number: try fewer looks.
    if (last > dearest_looks * needed) continue;
    if (last <= first) return one_look(last, whole);
    return stats::schedule_looks(sizes_up_to(last, first, growth, count), law, errors);
  }
  return one_look(std::min(std::max(first, *alone), most), whole);
}

std::vector<std::uint64_t> postponed_looks(const TestOutcome& test, std::uint64_t most) {
  const Question& question = test.question;
  const Plan& plan = test.plan;
  const bool chosen = question.test->secondaries || has_rows(question);
  if (chosen || plan.method.is.over_looks != stats::LookLaw::independent_increments) return {};
  std::vector<std::uint64_t> sizes;
  std::uint64_t size = plan.most_secondaries();
  for (std::uint64_t times = 2; times <= most_postponed && size < most; times *= 2) {
    size = std::min(2 * size, most);
    sizes.push_back(size);
  }
  return sizes;
}

stats::LookSchedule look_for_its_picture(const TestOutcome& test) {
  const bool given = test.question.test->secondaries || has_rows(test.question);
  if (given || test.plan.method.keeps == Keeps::blocks) return test.plan.looks;
  return one_look(std::min(test.plan.looks.sizes.front(), usual_secondaries), test.place.share);
}

std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < test.plan.primaries.size(); ++i) {
    const Subject& side = test.question.subjects[i];
    sum += primaries_of_observation(*side.setup, test.plan.primaries[i]) * side.secondaries(look);
  }
  return sum;
}

}  // namespace assay::harness
