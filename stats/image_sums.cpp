#include "stats/image_sums.h"

#include <algorithm>
#include <array>
#include <span>

namespace assay::stats {
namespace {

constexpr std::size_t in_step = 8;

// Images that are missing to the last eight are the last one again.
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

}  // namespace

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

}  // namespace assay::stats
