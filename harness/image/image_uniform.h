#pragma once

// What a difference that is the same, or in proportion, in every pixel is found by: the sum over
// one channel of the whole image.

#include <vector>

#include "harness/sampling/picture_look.h"
#include "stats/images/image.h"

namespace assay::harness {

/// Of replicates: the spread of their means says how far pixels depend on each other.
template <class Real>
ChannelMeans channel_means(const stats::ImageStack<Real>& stack);

/// Of sums that stats::image_channel_sums made.
ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent);

/// Of numbers whose errors are independent between pixels.
ChannelMeans channel_means(const stats::ImageReference& reference);

/// Standard error of theta, were it the same everywhere, in the channel that tells it best:
/// absolute, or a part of the second's.
double uniform_error(const ChannelMeans& first, const ChannelMeans& second, bool relative);

}  // namespace assay::harness
