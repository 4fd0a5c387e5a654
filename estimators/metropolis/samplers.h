#pragma once

// The small step as samplers that can be tested by themselves.

#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "metropolis/small_step.h"

namespace assay::metropolis {

/// `step`: the signed length, of density 1 / (2 |x| ln(largest / smallest)). `coordinate`: a
/// uniform number after a small step, staying where a step is rejected; uniform again.
std::vector<NamedSampler> step_samplers(const std::shared_ptr<const SmallStep>& step);

}  // namespace assay::metropolis
