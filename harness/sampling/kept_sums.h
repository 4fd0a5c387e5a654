#pragma once

// Sums over observations that are kept whole.

#include <span>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// The summary of every channel over these observations, of which there is one at least, and of
/// pictures that of their average besides: the moments of finite values, some channels of all
/// observations at a time, on all threads of the caller's arena. The same bits for any number of
/// them.
std::vector<ChannelSummary> sums_of_kept(const Observations& observations);

}  // namespace assay::harness
