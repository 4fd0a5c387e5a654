#include "stats/images/image_sums.h"

#include <algorithm>
#include <array>
#include <span>

namespace assay::stats {
namespace {

constexpr std::size_t in_step = 8;

// The last image, repeated, fills up the last eight.
template <class Real>
void add_in_step(std::span<double> sums, const ImageStack<Real>& stack, std::size_t first,
                 ElementRange range) {
  std::array<const Real*, in_step> image{};
  std::array<double, in_step> sum{};
  for (std::size_t k = 0; k < in_step; ++k) {
    image[k] = stack.at(std::min(first + k, stack.images.size() - 1), range.first);
  }
  std::ranges::copy(sums, sum.begin());
  for (std::size_t i = 0; i < range.size(); ++i) {
    for (std::size_t k = 0; k < in_step; ++k) sum[k] += static_cast<double>(image[k][i]);
  }
  std::copy_n(sum.begin(), sums.size(), sums.begin());
}

// The number of channels is known at compile time, so their sums stay in registers.
template <std::size_t channels, class Real>
void add_channels(std::span<double> sums, std::span<const Real> elements) {
  std::array<double, channels> sum{};
  std::ranges::copy(sums, sum.begin());
  for (std::size_t i = 0; i < elements.size(); i += channels) {
    for (std::size_t c = 0; c < channels; ++c) sum[c] += static_cast<double>(elements[i + c]);
  }
  std::ranges::copy(sum, sums.begin());
}

template <class Real>
void add_channels_of(std::span<double> sums, std::span<const Real> elements) {
  if (sums.size() == 1) return add_channels<1>(sums, elements);
  if (sums.size() == 3) return add_channels<3>(sums, elements);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    sums[i % sums.size()] += static_cast<double>(elements[i]);
  }
}

}  // namespace

template <class Real>
void add_to_channel_sums(std::vector<double>& sums, const ImageStack<Real>& stack,
                         ElementRange range, const ForEach& for_each) {
  const std::size_t channels = stack.extent.channels;
  for_each(stack.images.size(), [&](std::size_t i) {
    add_channels_of<Real>(std::span(sums).subspan(i * channels, channels),
                          {stack.at(i, range.first), range.size()});
  });
}

template <class Real>
std::vector<double> image_channel_sums(const ImageStack<Real>& stack, const ForEach& for_each) {
  std::vector<double> sums(stack.images.size() * stack.extent.channels);
  add_to_channel_sums(sums, stack, {0, stack.extent.elements()}, for_each);
  return sums;
}

template <class Real>
void add_to_sums(std::vector<double>& sums, const ImageStack<Real>& stack, ElementRange range,
                 const ForEach& for_each) {
  for_each((sums.size() + in_step - 1) / in_step, [&](std::size_t i) {
    const std::size_t first = i * in_step;
    const std::size_t size = std::min(in_step, sums.size() - first);
    add_in_step(std::span(sums).subspan(first, size), stack, first, range);
  });
}

template <class Real>
std::vector<double> image_sums(const ImageStack<Real>& stack, const ForEach& for_each) {
  std::vector<double> sums(stack.images.size());
  add_to_sums(sums, stack, {0, stack.extent.elements()}, for_each);
  return sums;
}

template void add_to_sums(std::vector<double>&, const ImageStack<float>&, ElementRange,
                          const ForEach&);
template void add_to_sums(std::vector<double>&, const ImageStack<double>&, ElementRange,
                          const ForEach&);
template std::vector<double> image_sums(const ImageStack<float>&, const ForEach&);
template std::vector<double> image_sums(const ImageStack<double>&, const ForEach&);
template void add_to_channel_sums(std::vector<double>&, const ImageStack<float>&, ElementRange,
                                  const ForEach&);
template void add_to_channel_sums(std::vector<double>&, const ImageStack<double>&, ElementRange,
                                  const ForEach&);
template std::vector<double> image_channel_sums(const ImageStack<float>&, const ForEach&);
template std::vector<double> image_channel_sums(const ImageStack<double>&, const ForEach&);

}  // namespace assay::stats
