#include "harness/image/image_uniform.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/base/parallel.h"
#include "stats/basics/moments.h"
#include "stats/images/image_sums.h"

namespace assay::harness {

template <class Real>
ChannelMeans channel_means(const stats::ImageStack<Real>& stack) {
  return channel_means(stats::image_channel_sums(stack, on_all_threads), stack.extent);
}
template ChannelMeans channel_means(const stats::ImageStack<float>&);
template ChannelMeans channel_means(const stats::ImageStack<double>&);

ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent) {
  const auto pixels = static_cast<double>(extent.width * extent.height);
  ChannelMeans means;
  for (std::size_t c = 0; c < extent.channels; ++c) {
    stats::Moments moments;
    for (std::size_t i = c; i < sums.size(); i += extent.channels) moments.add(sums[i] / pixels);
    means.push_back({moments.mean, moments.standard_error()});
  }
  return means;
}

ChannelMeans channel_means(const stats::ImageReference& reference) {
  const std::size_t channels = reference.extent.channels;
  const auto pixels = static_cast<double>(reference.extent.width * reference.extent.height);
  ChannelMeans means(channels);
  for (std::size_t i = 0; i < reference.value.size(); ++i) {
    Constant& mean = means[i % channels];
    mean.value += reference.value[i] / pixels;
    if (reference.standard_error.empty()) continue;
    mean.standard_error = std::hypot(mean.standard_error, reference.standard_error[i] / pixels);
  }
  return means;
}

double uniform_error(const ChannelMeans& first, const ChannelMeans& second, bool relative) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < first.size(); ++c) {
    const double error = std::hypot(first[c].standard_error, second[c].standard_error);
    least = std::min(least, relative ? error / std::abs(second[c].value) : error);
  }
  return least;
}

}  // namespace assay::harness
