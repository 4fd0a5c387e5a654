#pragma once

// Judges whether observations are independent. Rows of a file are a sample that is its own pilot,
// and only their order shows it.

#include <cstdint>
#include <span>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/theta/methods.h"

namespace assay::harness {

/// In fewer rows batches of sqrt n are too few and too short.
inline constexpr std::size_t fewest_in_order = 9;

/// Throws InputError at the claim if the first `count` data of two sides coincide beyond chance.
/// They may share a picture (recorded::Pictures) or a run of rows (stats/gates/copies.h).
/// Two sources of one file are another mistake.
void require_independent_sides(const Question& question, const Pilots& pilots, std::uint64_t count);

/// Notes what the first `count` rows of every recorded subject say of independence
/// (stats/gates/independence_gates.h). Dependent rows make a test of means one of batch means, if
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
