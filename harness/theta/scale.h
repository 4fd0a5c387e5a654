#pragma once

// The scale that theta is on: absolute, relative to a mean, or the logarithm of a ratio.

#include <cstddef>

#include "harness/question/question.h"

namespace assay::harness {

/// Divisor of a channel's theta: |reference| or |factor * other_mean| if theta is relative, else
/// 1. `other_mean` counts only if the claim compares two.
double unit_of_theta(const Question& question, std::size_t channel, double other_mean);

/// A margin of the claim on theta's scale: ln(1 + x) for a ratio of variances.
double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin);

/// True if a margin of the test is given in per cent, or as a number.
bool has_relative_margin(const TestEntry& test);
bool has_absolute_margin(const TestEntry& test);

}  // namespace assay::harness
