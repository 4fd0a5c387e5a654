#include "harness/kept_sums.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "stats/image_element_moments.h"

namespace assay::harness {
namespace {

constexpr std::size_t channels_at_a_time = 4096;

/// One by one, as observations are taken elsewhere: with what is not finite counted by itself.
ChannelSummary one_by_one(const stats::ImageStack<double>& stack, std::size_t channel) {
  ChannelSummary summary;
  for (std::size_t i = 0; i < stack.images.size(); ++i) {
    add_observation(summary, stack.images[i][channel], i);
  }
  return summary;
}

void take(const stats::ImageStack<double>& stack, std::size_t first,
          std::span<ChannelSummary> out) {
  std::vector<stats::Moments> moments(out.size());
  stats::element_moments(stack, first, moments);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (std::isfinite(moments[i].m2)) {
      out[i].moments = moments[i];
    } else {
      out[i] = one_by_one(stack, first + i);
    }
  }
}

}  // namespace

std::vector<ChannelSummary> sums_of_kept(std::span<const std::vector<double>> observations) {
  const std::size_t channels = observations.front().size();
  stats::ImageStack<double> stack{{.width = channels, .height = 1}, {}};
  stack.images.assign(observations.begin(), observations.end());
  std::vector<ChannelSummary> sums(channels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, channels, channels_at_a_time),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      take(stack, range.begin(),
                           std::span(sums).subspan(range.begin(), range.size()));
                    });
  return sums;
}

}  // namespace assay::harness
