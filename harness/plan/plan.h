#pragma once

// From the pilot to frozen plans: primaries of a secondary, method, and secondaries that find
// `detect` with the suite's error rates.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/draws/sampler_setup.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/theta/methods.h"
#include "stats/planning/boundary.h"

namespace assay::harness {

/// Places of a suite's questions, in order. Inside the family alpha is split by weight, then evenly
/// over a claim's channels. A test outside has the smallest share in the suite, and beta over the
/// number of tests outside. A suite of mutants only shares out alpha among them. A test without a
/// question keeps its part.
std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions);

/// Primaries of a secondary for each averaging estimator that says `auto`. Variance claims get
/// near-normal secondaries, mean claims a right tail at their level. The number depends on the
/// whole suite, not on a selection.
using Primaries = std::map<std::string, std::uint64_t>;
Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots);

/// One test with its plan. Where the pilots show a mistake, as a margin beyond reach, it is an
/// error.
TestOutcome plan_test(Question asked, const FamilyPlace& place, const Pilots& pilots,
                      const Primaries& primaries);
/// The same as a suite of its own, drawn by itself.
TestOutcome plan_alone(const Suite& suite, const Question& question, const Pilots& pilots);

/// A sentence on a `detect` without per cent that is nearly all of what is claimed, or next to
/// nothing of it; "" for another.
std::string doubtful_margin(const Question& question, const Pilots& pilots);

/// The message of a test whose claim needs a density that cannot be had.
std::string lack_of_density(const Question& question, const NoDensity& why);

/// Expected behaviour of a frozen plan, from the pilots.
struct Forecast {
  /// The least theta that the last look finds with probability 1 - beta; for `within` the least
  /// margin that it proves if theta is 0. The largest over the channels; nullopt if no formula
  /// tells.
  std::optional<double> detectable = {};
  /// Theta is 0 in every channel; for `<` and `>` the claim holds by `detect`.
  std::optional<stats::Outlook> if_true = {};
  /// Theta is at the edge of the forbidden region, in the channel that passes most often.
  std::optional<stats::Outlook> if_off = {};
};

/// The outlooks follow from the joint normal law of the looks' scores. A method that bets has none.
Forecast forecast(const TestOutcome& test, const Pilots& pilots);

/// The cost of an observation.
struct PilotedCost {
  double rays = 0;
  double samples = 0;
  double seconds = 0;  ///< of CPU time
};

/// By the subject's pilot, of which averages are nearer to an observation. A sampler's draw takes
/// the time of a primary of its estimator, and no rays. nullopt without a pilot.
std::optional<PilotedCost> observation_cost(const Subject& subject, std::uint64_t primaries,
                                            const Pilots& pilots);

/// Expected secondaries of a test whose claim holds; the last look's if that is not known.
std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots);

// ---- Independence of observations. Rows of a file are a sample that is its own pilot, and only
// their order shows it.

/// In fewer rows batches of sqrt n are too few and too short.
inline constexpr std::size_t fewest_in_order = 9;

/// Throws InputError at the claim if the first `count` data of two sides coincide beyond chance.
/// They may share a picture (recorded::Pictures) or a run of rows (stats/gates/copies.h).
/// Two sources of one file are another mistake.
void require_independent_sides(const Question& question, const Pilots& pilots, std::uint64_t count);

/// Notes what the first `count` rows of every recorded subject say of independence
/// (stats/gates/dependence.h). Dependent rows make a test of means one of batch means, if
/// they are enough, and other tests invalid. A run of rows that recurs (stats/gates/copies.h) makes
/// any test invalid, a forced method as well. For dependence too weak for a gate, a test of means
/// allows (stats::allowance_for_dependence).
void judge_independence(TestOutcome& test, const Pilots& pilots, std::uint64_t count);

/// The moments that a test of means takes, of batch means if that is its method. Rows with an
/// allowance get larger deviations: those of independent values with as uncertain a mean.
stats::Moments as_tested(const Plan& plan, std::size_t subject, std::size_t channel,
                         std::span<const double> values, stats::Moments moments);

/// True if a subject's observations are drawn one by one, and not as pictures. Their order then
/// shows whether they are independent. judge_independence judges rows.
bool shows_order(const Subject& subject);

/// Adds the red gates on the order of what a subject drew, in its pilot or for the test. Dependence
/// makes every method invalid, a forced one as well.
void judge_order(const Subject& subject, const Drawn& drawn, std::vector<Gate>& gates,
                 Reason& invalid);

}  // namespace assay::harness
