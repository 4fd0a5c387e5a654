#pragma once

#include "harness/question/question.h"
#include "harness/theta/family.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// The normal quantile beyond which a test of this share rejects.
double critical_value(double alpha, bool two_sided);

// Each look doubles the sample. Ten cost a tenth to a third more at the last look (README.md) and
// let a test end after 1/512 of it.
inline constexpr double look_growth = 2;
inline constexpr std::size_t most_looks = 10;

// Fewer observations say nothing about their own shape.
inline constexpr std::uint64_t least_secondaries = 100;
// What a test without `detect` takes.
inline constexpr std::uint64_t usual_secondaries = 1000;

/// The smallest part of a share that a look of this test may have.
double smallest_share(const Question& question, double share);

/// The smallest level at which a look of this test may be taken.
double smallest_level(const Question& question, const FamilyPlace& place);

/// Whether the claim's test rejects in both tails.
bool two_sided(const Question& question);

/// Limits of the pilot's gates at this critical value: the excess kurtosis at which the level of
/// chi-square and F is 1.25 times nominal (x is divided by sqrt(1 + excess / 2), so the bound is
/// stricter at smaller levels), .2 at most.
stats::ShapeLimits shape_limits(double critical);

}  // namespace assay::harness
