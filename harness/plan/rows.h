#pragma once

// Rows of a file: a sample that is its own pilot, and of which only its order tells whether it is
// independent.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"
#include "harness/theta/method.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// Below it batches of sqrt n are too few and too short to say anything.
inline constexpr std::size_t fewest_in_order = 9;

/// Whether a subject's observations are ready-made.
bool is_recorded(const Subject& subject);
/// Whether any of the question's are.
bool has_rows(const Question& question);

/// InputError at the claim where two sides that are held against each other as independent have the
/// same picture (recorded::shared_picture), the same run of rows (stats/repeated_run.h) or the same
/// rows in another order (stats/recurring_values.h), as chance does not make them, among the first
/// `count`. Two sources of one file are another mistake.
void require_independent_sides(const Question& question, const Pilots& pilots, std::uint64_t count);

/// Notes in the plan what the first `count` rows of every recorded subject say of independence
/// (stats/independence_gates.h). Dependent rows make a test of means one of batch means, if all the
/// rows are enough for them, and everything else invalid; so do a run of rows that occurs again
/// (stats/repeated_run.h) and values that occur equally often (stats/recurring_values.h). A forced
/// method is kept. Where the rows may depend on each other too weakly for a gate, a test of means
/// allows for it (stats::allowance_for_dependence).
void judge_independence(const Question& question, const Pilots& pilots, std::uint64_t count,
                        Plan& plan);

/// The moments that a test of means takes: of batch means where that is its method; of rows that
/// may depend on each other those of independent values whose mean is as uncertain, with deviations
/// so much larger; else `moments`.
stats::Moments as_tested(const Plan& plan, std::size_t subject, std::size_t channel,
                         std::span<const double> values, stats::Moments moments);

/// Gates on the shape of rows, of which no pilot spoke: on how many there are, how skewed their
/// mean is at critical value x, and for Kolmogorov and Smirnov how coarsely they were rounded.
std::vector<stats::Gate> row_gates(const TestOutcome& outcome, std::span<const ChannelData> data,
                                   double critical_value);

/// What explains a fail of two variances of which one is that of rows and the other that of a
/// primary, as a part of a sentence; "" of all others.
std::string rows_beside_primaries(const Question& question);

/// InputError at the record where rows of the suite came from standard input, a pipe or a device:
/// they are gone, and cannot be replayed.
void require_lasting_rows(const Suite& suite, const std::string& record);

}  // namespace assay::harness
