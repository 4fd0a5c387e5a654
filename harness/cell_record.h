#pragma once

// The cells of a claim that a sampler follows its density, as maps of the record.

#include "harness/evaluate.h"
#include "reports/record.h"

namespace assay::harness {

/// Adds what was observed and expected in each cell of a domain of two coordinates, over all lobes,
/// and (observed - expected) / sqrt(expected). Nothing of other claims, of an interval, and of a
/// test without numbers.
void add_cells(const TestWork& work, reports::Test& test);

}  // namespace assay::harness
