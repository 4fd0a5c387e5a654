#pragma once

#include "harness/question/question.h"
#include "harness/theta/family.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// The normal quantile beyond which a test at this level rejects.
double critical_value(double alpha, bool two_sided);

// Fewer observations do not show their own shape.
inline constexpr std::uint64_t least_secondaries = 100;
// Size of a test without `detect`.
inline constexpr std::uint64_t usual_secondaries = 1000;

// Primaries below which no mean without a declared range is decided. No test knows of a rare bright
// value that it never drew (Bahadur & Savage 1956).
inline constexpr std::uint64_t floor_of_evidence = std::uint64_t{1} << 14;

// A method is taken to keep its level up to this factor.
inline constexpr double level_factor = 1.25;

// A test has at most so many looks: one may end after 1/181 of the last.
inline constexpr std::size_t most_looks = 16;

/// An even part of a share, for a look of this test. A look with a smaller level need not keep it
/// better than the part.
double smallest_share(const Question& question, double share);

/// The level up to which a method of this test must keep its own.
double smallest_level(const Question& question, const FamilyPlace& place);

/// Limits of the pilot's gates at this critical value x. At the excess kurtosis (.2 at most)
/// chi-square and F have 1.25 times their nominal level. There x is divided by sqrt(1 + excess /
/// 2).
stats::ShapeLimits shape_limits(double critical);

}  // namespace assay::harness
