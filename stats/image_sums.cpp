#include "stats/image_sums.h"

#include <algorithm>
#include <array>

namespace assay::stats {
namespace {

constexpr std::size_t in_step = 8;

// Images that are missing to the last eight are the last one again.
template <class Real>
std::array<double, in_step> sums_from(const ImageStack<Real>& stack, std::size_t first) {
  std::array<const Real*, in_step> image{};
  for (std::size_t k = 0; k < in_step; ++k) {
    image[k] = stack.images[std::min(first + k, stack.images.size() - 1)].data();
  }
  std::array<double, in_step> sum{};
  const std::size_t size = stack.images[first].size();
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < in_step; ++k) sum[k] += static_cast<double>(image[k][i]);
  }
  return sum;
}

}  // namespace

template <class Real>
std::vector<double> image_sums(const ImageStack<Real>& stack, const ForEach& for_each) {
  std::vector<double> sums(stack.images.size());
  for_each((sums.size() + in_step - 1) / in_step, [&](std::size_t i) {
    const std::size_t first = i * in_step;
    const auto some = sums_from(stack, first);
    std::copy_n(some.begin(), std::min(in_step, sums.size() - first), sums.data() + first);
  });
  return sums;
}

template std::vector<double> image_sums(const ImageStack<float>&, const ForEach&);
template std::vector<double> image_sums(const ImageStack<double>&, const ForEach&);

}  // namespace assay::stats
