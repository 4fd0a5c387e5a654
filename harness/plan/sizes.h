#pragma once

// Sizes of tests: levels at which they are planned, secondaries of each subject, floors.

#include <cstdint>
#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/question/question.h"
#include "harness/theta/decision.h"
#include "harness/theta/theta.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// The normal quantile beyond which a test at this level rejects.
double critical_value(double alpha, bool two_sided);

// Fewer observations do not show their own shape.
inline constexpr std::uint64_t least_secondaries = 100;
// Size of a test without `detect`.
inline constexpr std::uint64_t usual_secondaries = 1000;

// Replicates of a claim on images without `detect`.
inline constexpr std::uint64_t classical_replicates = 64;

// Primaries below which no mean without a declared range is decided. No test knows of a rare bright
// value that it never drew (Bahadur & Savage 1956).
inline constexpr std::uint64_t floor_of_evidence = std::uint64_t{1} << 14;

/// Looks that a test has at most: one may end after 1/181 of the last. With a budget in seconds,
/// which the first look is not to exceed, one may end after 1/740,000.
std::size_t most_looks(const FamilyPlace& place);

/// True if `detect` or `within` determines the size.
bool has_planned_size(const Question& question);

/// The excess kurtosis up to which F and chi-square serve this test, 0.2 at most. At it they have
/// 1.25 times the nominal level at the test's critical value x. There x is divided by sqrt(1 +
/// excess / 2). The level is an even part of the test's share for each look. A look with a smaller
/// level need not keep it better.
double kurtosis_limit(const Question& question, const FamilyPlace& place);

/// An alarm rejects the claimed region at alpha and misses with beta. A proof rejects the forbidden
/// region at beta. For `within` both sides are rejected, and each misses with beta / 2.
stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions);

/// The t test of a channel's mean, or of its two means, for the subjects' own sizes. The true theta
/// is above (1) or below (-1) the reference. Theta is taken for such a mean where it is the
/// logarithm of a ratio.
stats::MeanPlan mean_plan(const Sized& sized, int side);
/// Secondaries, as many of each subject, with which a t test finds the channel's `detect`.
std::uint64_t secondaries_by_t(const Method& method, const stats::ErrorRates& rates,
                               const PlannedChannel& channel);

/// Secondaries that the floor of evidence asks for, at least `least_secondaries`. Rows
/// of a file, pictures and files that a program writes are as many as somebody paid for: they have
/// no floor.
std::uint64_t secondaries_of_floor(const TestOutcome& test);

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share);

/// Primaries of a look of this size, all subjects together; of an image, in all its elements.
std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look);

/// A computed count, rounded up; `impossible_secondaries` if it is too large or NaN.
std::uint64_t whole_secondaries(double count);

/// True if every subject has a pilot.
bool all_piloted(const Question& question, const Pilots& pilots);

/// The distance to find from the claimed region's edge; 0 if there is none.
double distance_of(const Regions& regions);

/// The least theta that a test of that size finds with probability 1 - beta. For `within` it is the
/// least margin that the test proves if theta is 0. Returns nullopt if no formula tells.
std::optional<double> detectable_effect(const Sized& sized);

}  // namespace assay::harness
