#pragma once

// Counted costs, and the truth of a biased estimator's mean.

#include <span>
#include <vector>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// The values with the cost that the test counts, rays or samples.
const stats::JointMoments& by_its_cost(const Question& question,
                                       std::span<const stats::JointMoments> joint);

/// Values with their cost, in rays or samples. Throws std::domain_error if nothing was counted.
const stats::JointMoments& counted_cost(const Question& question, const ChannelData& data);

/// The powers of a channel's values, as far as they are kept: a cost means nothing.
stats::JointMoments powers_of_values(const ChannelData& data);

/// The truth of a subject's mean: its number, or the mean of the drawn reference.
Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data);

}  // namespace assay::harness
