#pragma once

// Sizes for claims about quantiles, slopes and a sampler's bookkeeping, for sample_size.

#include <cstdint>
#include <optional>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Planned by the pilot's counts over the distance to be found; means of several primaries count as
/// normal. If the density at the quantile differs, the size is off by its ratio and the verdict may
/// be inconclusive. The test itself is exact for every law.
std::optional<std::uint64_t> quantile_secondaries(const Question& question, const ErrorShare& share,
                                                  const Pilots& pilots, const Plan& plan);

/// Draws that show a probability off by `detect`. Exact binomial tests are planned as normal ones,
/// plus z^2 / room for discreteness. Returns `impossible_secondaries` if the quadrature's error
/// leaves no room between the margins, and nullopt without a margin.
std::optional<std::uint64_t> draws_secondaries(const Question& question, const ErrorShare& share,
                                               const Regions& regions);

/// Size for each subject, from a pilot that shows the claimed power law: its constant at the
/// claimed exponent exceeds three standard errors. Returns nullopt if it does not.
std::optional<std::uint64_t> slope_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan);

}  // namespace assay::harness
