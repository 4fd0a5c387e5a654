#pragma once

#include "harness/run/evaluate.h"

namespace assay::harness {

/// Fills in a decided test's effect and least detectable effect for every channel, and the least
/// power over them. The power is that at `detect`; for `within` it is that of showing theta = 0.
void note_sizes(TestOutcome& outcome, const DrawnTest& test);

}  // namespace assay::harness
