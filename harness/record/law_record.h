#pragma once

// Records laws: empirical distribution functions, and the cells of two coordinates as maps.

#include <cstddef>
#include <vector>

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds observed and expected counts of each cell and (observed - expected) / sqrt(expected). A
/// sampler is compared with its density, summed over all lobes. Two samples are compared by
/// chi-square-two-sample: the expected count is the first one's part of both together. Its
/// difference is divided by its standard deviation, sqrt(expected m / (n + m)). Adds nothing for
/// other claims, one coordinate, unequal numbers of cells, and tests without numbers.
void add_cells(const DrawnTest& drawn, reports::Test& test);

/// Each side's empirical distribution function with its simultaneous band and the claimed law, at
/// 63 or fewer points equally spaced in rank. The band's error is the channel's share of alpha at
/// the look. Draws without a point are left out. Empty unless the claim compares values of one
/// coordinate.
std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
