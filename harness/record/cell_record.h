#pragma once

// The cells that a claim on a law of two coordinates is judged by, as maps of the record.

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Adds what was observed and expected in each cell and (observed - expected) / sqrt(expected): of
/// a sampler against its density, over all lobes; of two samples by chi-square-two-sample, where
/// expected is the first one's part of both together and the difference is divided by its standard
/// deviation, sqrt(expected m / (n + m)). Nothing of other claims, of one coordinate, of bands with
/// different numbers of cells, and of a test without numbers.
void add_cells(const DrawnTest& drawn, reports::Test& test);

}  // namespace assay::harness
