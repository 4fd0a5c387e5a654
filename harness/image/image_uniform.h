#pragma once

// Sums over one channel of the whole image. They find a difference that is the same, or
// proportional, in every pixel.

#include <vector>

#include "harness/sampling/element_sums.h"
#include "stats/images/image.h"

namespace assay::harness {

/// Means of replicates. The spread of these means shows how far pixels depend on each other.
template <class Real>
ChannelMeans channel_means(const stats::ImageStack<Real>& stack);

/// Means from the sums of stats::image_channel_sums.
ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent);

/// Means of numbers whose errors are independent between pixels.
ChannelMeans channel_means(const stats::ImageReference& reference);

/// Makes means the unit of something else.
inline void drop_errors(ChannelMeans& means) {
  for (Constant& mean : means) mean.standard_error = 0;
}

/// Standard error of a theta that is the same everywhere, in the best channel: absolute, or a part
/// of the second's mean.
double uniform_error(const ChannelMeans& first, const ChannelMeans& second, bool relative);

}  // namespace assay::harness
