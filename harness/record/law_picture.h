#pragma once

#include <cstddef>
#include <vector>

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Each side's empirical distribution function with its simultaneous band and the claimed law, at
/// 63 or fewer points equally spaced in rank. The band's error is the channel's share of alpha at
/// the look. Draws without a point are left out. Empty unless the claim compares values of one
/// coordinate.
std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
