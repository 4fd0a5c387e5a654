#pragma once

// Records the cells of a claim on a law of two coordinates as maps.

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds observed and expected counts of each cell and (observed - expected) / sqrt(expected). A
/// sampler is compared with its density, summed over all lobes. Two samples are compared by
/// chi-square-two-sample: the expected count is the first one's part of both together. Its
/// difference is divided by its standard deviation, sqrt(expected m / (n + m)). Adds nothing for
/// other claims, one coordinate, unequal numbers of cells, and tests without numbers.
void add_cells(const DrawnTest& drawn, reports::Test& test);

}  // namespace assay::harness
