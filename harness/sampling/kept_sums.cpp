#include "harness/sampling/kept_sums.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "stats/images/image_element_moments.h"
#include "stats/images/image_sums.h"

namespace assay::harness {
namespace {

constexpr std::size_t channels_at_a_time = 4096;

/// Adds values one by one, as elsewhere; non-finite ones are counted apart.
template <class Real>
ChannelSummary one_by_one(const stats::ImageStack<Real>& stack, std::size_t channel) {
  ChannelSummary summary;
  for (std::size_t i = 0; i < stack.images.size(); ++i) {
    add_observation(summary, *stack.at(i, channel), i);
  }
  return summary;
}

template <class Real>
void take(const stats::ImageStack<Real>& stack, std::size_t first, std::span<ChannelSummary> out) {
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

/// Sums of a range of the elements.
template <class Real>
void take_all(const stats::ImageStack<Real>& stack, stats::ElementRange range,
              std::span<ChannelSummary> out) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(range.first, range.last, channels_at_a_time),
                    [&](const tbb::blocked_range<std::size_t>& some) {
                      take(stack, some.begin(),
                           out.subspan(some.begin() - range.first, some.size()));
                    });
}

std::vector<ChannelSummary> sums_of(std::span<const std::vector<double>> observations) {
  const std::size_t channels = observations.front().size();
  std::vector<ChannelSummary> sums(channels);
  take_all<double>({{.width = channels, .height = 1}, {observations.begin(), observations.end()}},
                   {0, channels}, sums);
  return sums;
}

std::vector<double> averages_of(std::span<const std::span<const float>> pictures) {
  constexpr std::size_t at_a_time = 8;
  const std::size_t elements = pictures.front().size();
  std::vector<double> averages(pictures.size());
  tbb::parallel_for(std::size_t{0}, pictures.size(), at_a_time, [&](std::size_t first) {
    const auto some = pictures.subspan(first, std::min(at_a_time, pictures.size() - first));
    const std::vector<double> sums = stats::image_sums(
        stats::ImageStack<float>{{.width = elements, .height = 1}, {some.begin(), some.end()}});
    for (std::size_t i = 0; i < sums.size(); ++i) {
      averages[first + i] = sums[i] / static_cast<double>(elements);
    }
  });
  return averages;
}

ChannelSummary sum_of(std::span<const double> averages) {
  stats::ImageStack<double> stack{{.width = 1, .height = 1}, {}};
  for (const double& average : averages) stack.images.emplace_back(&average, 1);
  ChannelSummary sum;
  take(stack, 0, {&sum, 1});
  return sum;
}

std::vector<ChannelSummary> sums_of(std::span<const std::span<const float>> pictures) {
  const std::size_t elements = pictures.front().size();
  std::vector<ChannelSummary> sums(elements + 1);
  take_all<float>({{.width = elements, .height = 1}, {pictures.begin(), pictures.end()}},
                  {0, elements}, sums);
  sums.back() = sum_of(averages_of(pictures));
  return sums;
}

}  // namespace

std::vector<ChannelSummary> sums_of_kept(const Observations& observations) {
  return std::visit([](const auto& each) { return sums_of(each); }, observations);
}

}  // namespace assay::harness
