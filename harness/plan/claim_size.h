#pragma once

// How many secondaries claims about quantiles, slopes and a sampler's bookkeeping take: a helper of
// sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// By how counts of the pilot's values move from the quantile over the distance to be found; of
/// means of several primaries as if they were normal with the pilot's standard deviation. Where
/// they are not, the plan is off by the ratio of the densities at the quantile, and the verdict may
/// be inconclusive; the test itself is exact for every law.
std::optional<std::uint64_t> quantile_secondaries(const Question& question, const ErrorShare& share,
                                                  const Pilots& pilots, const Plan& plan);

/// Draws by which a probability that is off by `detect` shows, exact binomial tests planned as
/// normal ones with one more z^2 / room for their discreteness. `impossible_secondaries` where the
/// quadrature's error leaves no room between the margins. Nothing without a margin.
std::optional<std::uint64_t> draws_secondaries(const Question& question, const ErrorShare& share,
                                               const Regions& regions);

/// For each subject, from a pilot that shows the claimed power law: its constant, fitted at the
/// claimed exponent, exceeds three of its standard errors. Nothing where it does not.
std::optional<std::uint64_t> slope_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan);

}  // namespace assay::harness
