#pragma once

#include <vector>

#include "harness/evaluate.h"

namespace assay::harness {

/// Holm over the tests of one suite inside the family: fills in adjusted p-values and turns a pass
/// or inconclusive into a fail where Holm rejects what the fixed share did not. Invalid and error
/// enter as 1.
void apply_holm(const std::vector<TestWork*>& suite, double alpha);

}  // namespace assay::harness
