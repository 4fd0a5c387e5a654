#pragma once

// Sums over observations that are kept whole.

#include <span>
#include <vector>

#include "harness/image_views.h"
#include "harness/summary.h"
#include "stats/image.h"

namespace assay::harness {

/// The summary of every channel over these observations, of which there is one at least, and of
/// pictures that of their average besides: the moments of finite values, some channels of all
/// observations at a time, on all threads of the caller's arena. The same bits for any number of
/// them.
std::vector<ChannelSummary> sums_of_kept(const Observations& observations);

/// The same of pictures of which some rows are there at a time: of the elements in these rows, to
/// their places in `sums`.
void sum_rows(const stats::ImageStack<float>& pictures, stats::RowRange rows,
              std::span<ChannelSummary> sums);
/// Of averages over pictures.
ChannelSummary sum_of(std::span<const double> averages);

}  // namespace assay::harness
