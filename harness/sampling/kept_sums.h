#pragma once

#include <span>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// The summary of every channel over the observations, at least one; for pictures also of their
/// average. It has moments of the finite values. It works on all threads of the caller's arena and
/// gives the same bits for any number of threads.
std::vector<ChannelSummary> sums_of_kept(const Observations& observations);

}  // namespace assay::harness
