#pragma once

// The small step as samplers that can be tested by themselves.

#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "metropolis/small_step.h"

namespace assay::metropolis {

/// The samplers of a step. One is `step`, the signed length, of density 1 / (2 |x| ln(largest /
/// smallest)). The other is `coordinate`, a uniform number after a small step; it stays if a step
/// is rejected. It is uniform again.
std::vector<NamedSampler> step_samplers(const std::shared_ptr<const SmallStep>& step);

}  // namespace assay::metropolis
