#include "harness/plan/law_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/draws/sampler_setup.h"
#include "harness/plan/claim_size.h"
#include "harness/plan/look_sizes.h"
#include "stats/cells/chi_square_fit.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

stats::ErrorRates rates_of(const ErrorShare& share) {
  return {.alpha = share.alpha, .beta = share.beta, .two_sided = false};
}

stats::DistancePlan distance_plan(const Question& question, const ErrorShare& share, double allow,
                                  double allocation = 1) {
  return {.two_samples = question.of_two(),
          .allocation = allocation,
          .allow = allow,
          .rates = rates_of(share)};
}

/// True if counts in cells are tested. A plan without frozen cells is invalid.
bool in_cells(const Plan& plan) {
  return plan.method.keeps == Keeps::cells || plan.method.frozen.cells != nullptr;
}

/// Degrees of freedom at so many observations. Cells that expect too few are pooled.
double degrees_of_freedom(const Question& question, const Plan& plan, double observations) {
  // Draws without a point are one more cell, so none is subtracted.
  if (plan.method.frozen.cells) return static_cast<double>(plan.method.frozen.cells->size());
  const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
  const double least = stats::FitOptions{}.minimum_expected;
  double pools = 0;
  for (const double p : draws.density_cells().mass.probability) {
    pools += std::min(1.0, observations * p / least);
  }
  pools += std::min(1.0, observations * draws.density_cells().missing() / least);
  return std::max(1.0, pools - 1);
}

stats::FitPlan fit_plan(const Question& question, const Plan& plan, const ErrorShare& share,
                        double observations) {
  return {.degrees_of_freedom = degrees_of_freedom(question, plan, observations),
          .allow = plan.regions[0].allow,
          .rates = rates_of(share)};
}

/// Fewer observations fill fewer pools, which need fewer observations. Each round's number is
/// enough; four rounds save nearly all.
std::optional<std::uint64_t> fit_secondaries(const Question& question, const ErrorShare& share,
                                             const Plan& plan) {
  double observations = std::numeric_limits<double>::max();
  std::optional<std::uint64_t> enough;
  for (int round = 0; round < 4; ++round) {
    const auto found = stats::chi_square_fit_sample_size(
        fit_plan(question, plan, share, observations), *plan.regions[0].detect);
    if (!found) return enough;
    enough = found;
    observations = static_cast<double>(*found);
  }
  return enough;
}

/// Observations of each side worth one of a single sample, by m n / (m + n).
std::uint64_t sides(const Question& question) { return question.of_two() ? 2 : 1; }

double worth(const Question& question, const TestSize& size) {
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  return question.of_two() ? sizes.x / (1 + sizes.x / sizes.y) : sizes.x;
}

/// The largest share of an atom over the channels.
std::optional<double> largest_atom(const Method& method) {
  std::optional<double> largest;
  for (const std::optional<Atom>& atom : method.frozen.atoms) {
    if (atom) largest = std::max(largest.value_or(0), atom->share);
  }
  return largest;
}

}  // namespace

std::optional<std::uint64_t> laws_secondaries(const Question& question, const ErrorShare& share,
                                              const Plan& plan) {
  const Regions& regions = plan.regions[0];
  if (question.of_draws()) return draws_secondaries(question, share, regions);
  if (!regions.detect) return std::nullopt;
  if (in_cells(plan)) {
    const auto alone = fit_secondaries(question, share, plan);
    return alone ? sides(question) * *alone : impossible_secondaries;
  }
  const std::optional<double> atom = largest_atom(plan.method);
  const ErrorShare each{.alpha = atom ? share.alpha / 2 : share.alpha, .beta = share.beta};
  const auto count =
      stats::ks_sample_size(distance_plan(question, each, regions.allow), *regions.detect);
  // If the pilot saw the atom alone, the rest is not planned for.
  if (!count || !atom || *atom >= 1) return count;
  const double all = std::ceil(static_cast<double>(*count) / (1 - *atom));
  return all < 0x1p53 ? static_cast<std::uint64_t>(all) : impossible_secondaries;
}

double detectable_between_laws(const Question& question, const TestSize& size, const Plan& plan) {
  if (in_cells(plan)) {
    const double observations = worth(question, size);
    return stats::chi_square_fit_detectable(fit_plan(question, plan, size.share, observations),
                                            observations);
  }
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  return stats::ks_detectable(
      distance_plan(question, size.share, plan.regions[0].allow, sizes.y / sizes.x), sizes.x);
}

double power_between_laws(const Question& question, const TestSize& size, const Plan& plan,
                          double effect) {
  if (in_cells(plan)) {
    const double observations = worth(question, size);
    return stats::chi_square_fit_power(fit_plan(question, plan, size.share, observations),
                                       observations, effect);
  }
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  return stats::ks_power_bound(
      distance_plan(question, size.share, plan.regions[0].allow, sizes.y / sizes.x), sizes.x,
      effect);
}

}  // namespace assay::harness
