#pragma once

// Sums over observations that are kept whole.

#include <span>
#include <vector>

#include "harness/summary.h"

namespace assay::harness {

/// The summary of every channel over these observations, of which there is one at least: the
/// moments of finite values, some channels of all observations at a time, on all threads of the
/// caller's arena. The same bits for any number of them.
std::vector<ChannelSummary> sums_of_kept(std::span<const std::vector<double>> observations);

}  // namespace assay::harness
