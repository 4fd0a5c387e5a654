#include "harness/plan/primaries.h"

#include <algorithm>
#include <bit>

#include "harness/plan/pilot_shape.h"
#include "harness/plan/sizes.h"
#include "harness/sampling/beyond_doubles.h"
#include "harness/theta/constant.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {
namespace {

// Below this the cost of an observation shows: its stream and moments.
constexpr std::uint64_t least_primaries = 64;
// Beyond this a larger mean no longer tames the tail in reasonable time.
constexpr std::uint64_t most_primaries = 4096;

bool chooses_primaries(const Subject& subject) {
  return subject.averages && subject.purpose.empty() && !subject.estimator->primaries;
}

/// Primaries that one question wants of one estimator.
std::uint64_t wanted_primaries(const Question& question, const FamilyPlace& place,
                               std::size_t subject, const Pilots& pilots) {
  std::uint64_t wanted = least_primaries;
  if (!question.is().of_spread) return wanted;
  const double x =
      critical_value(smallest_level(question, place), is_two_sided(question.test->claim.relation));
  for (std::size_t channel = 0; channel < question.subjects[subject].channels.size(); ++channel) {
    const stats::Moments& pilot = pilot_channel(question, subject, channel, pilots).moments;
    if (is_constant(question, subject, channel, pilot)) continue;
    if (!beyond_doubles(pilot, "").empty()) continue;  // the plan says so
    wanted = std::max(wanted,
                      stats::primaries_for_variance(stats::primary_shape(pilot), shape_limits(x)));
  }
  return wanted;
}

}  // namespace

bool takes_single_primaries(const Question& question, const Pilots& pilots) {
  if (question.is().of_single_values) return true;
  return question.is().of_moments && !question.is().of_spread && bets_on_range(question, pilots);
}

Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots) {
  Primaries chosen;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const Question& question = questions[i];
    if (takes_single_primaries(question, pilots)) continue;
    for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
      const Subject& side = question.subjects[subject];
      if (!chooses_primaries(side) || pilot_of(side, pilots) == nullptr) continue;
      const std::uint64_t wanted = wanted_primaries(question, places[i], subject, pilots);
      std::uint64_t& primaries = chosen[side.estimator->name];
      // A power of two: pilots of other seeds mostly choose the same.
      primaries = std::max(primaries, std::bit_ceil(std::min(wanted, most_primaries)));
    }
  }
  // Sides of a pair draw the same random numbers only if they draw as many.
  for (bool moved = true; moved;) {
    moved = false;
    for (const Question& question : questions) {
      if (!question.is().of_pairs) continue;
      const auto first = chosen.find(question.subjects[0].estimator->name);
      const auto second = chosen.find(question.subjects[1].estimator->name);
      if (first == chosen.end() || second == chosen.end()) continue;
      moved = moved || first->second != second->second;
      first->second = second->second = std::max(first->second, second->second);
    }
  }
  return chosen;
}

std::uint64_t primaries_of(const Subject& subject, const Primaries& chosen) {
  if (!subject.purpose.empty()) return 1;
  if (subject.estimator->primaries) return *subject.estimator->primaries;
  const auto found = chosen.find(subject.estimator->name);
  return found != chosen.end() ? found->second : 1;
}

}  // namespace assay::harness
