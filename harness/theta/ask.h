#pragma once

// Binds claims to the estimators of a suite, and checks what they ask for.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "harness/question/question.h"

namespace assay::harness {

/// Binds the claim. Sources that would share a stream under this seed get separate ones. InputError
/// at the claim's place for a part that does not exist, an unknown analytic reference, or channels
/// that do not pair. InputError also for a relative margin without a reference size, and for a
/// swept value that the plugin refuses.
Question ask(const TestEntry& test, const Estimators& estimators, std::uint64_t seed);

bool has_image(const Question& question);

inline constexpr double default_law_effect = 0.05;

/// ask() for a test as its user wrote it. A claim about laws gets the default `detect`, unless the
/// test has `detect` or `secondaries` or its rows are given. InputError if a margin is larger than
/// its reference or than any probability: the per cent sign is probably missing.
Question ask_as_written(TestEntry& test, const Estimators& estimators, std::uint64_t seed);

/// A key of the test as its user writes it: "`test: t`", or "`--test t`" of the command line.
std::string written_key(const TestEntry& test, const std::string& key, const std::string& value);

/// The size of a number that is at least 8 standard errors from 0, else 0. Margins cannot be
/// relative to a mean near 0.
inline double size_beyond_error(double value, double standard_error) {
  return std::abs(value) > 8 * standard_error ? std::abs(value) : 0;
}

/// Suggests the per cent spelling of an absolute margin larger than its reference `size`; "" for
/// other margins.
std::string missing_per_cent(const Margin& margin, double size);

/// Divisor of a channel's theta: |reference| or |factor * other_mean| if theta is relative, else
/// 1. `other_mean` counts only if the claim compares two.
double unit_of_theta(const Question& question, std::size_t channel, double other_mean);

/// A margin of the claim on theta's scale: ln(1 + x) for a ratio of variances.
double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin);

/// True if a margin of the test above 0 is given in per cent, or else as a number.
bool has_margin(const TestEntry& test, bool in_per_cent);

}  // namespace assay::harness
