#include "stats/images/image_element_moments.h"

#include <algorithm>
#include <array>

#include "stats/basics/check.h"
#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

// The sums of this many elements, and their values in a hundred images, stay in the cache.
constexpr std::size_t block_size = 512;
using Block = std::array<double, block_size>;

struct Sums {
  Block mean{};
  Block m2{};
  Block m3{};
  Block m4{};
  Block minimum{};
  Block maximum{};
  Block nonzero{};
};

template <class Real>
inline void add_differences(const Real* values, const Real* origin, double* sum, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    sum[i] += static_cast<double>(values[i]) - static_cast<double>(origin[i]);
  }
}

template <class Real>
inline void add_powers(const Real* values, Sums& sums, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    const double value = static_cast<double>(values[i]);
    const double deviation = value - sums.mean[i];
    const double square = deviation * deviation;
    sums.m2[i] += square;
    sums.m3[i] += square * deviation;
    sums.m4[i] += square * square;
    sums.minimum[i] = value < sums.minimum[i] ? value : sums.minimum[i];
    sums.maximum[i] = value > sums.maximum[i] ? value : sums.maximum[i];
    sums.nonzero[i] += value != 0 ? 1.0 : 0.0;
  }
}

ASSAY_VECTOR_COPIES void differences(const float* values, const float* origin, double* sum,
                                     std::size_t size) {
  add_differences(values, origin, sum, size);
}
ASSAY_VECTOR_COPIES void differences(const double* values, const double* origin, double* sum,
                                     std::size_t size) {
  add_differences(values, origin, sum, size);
}
ASSAY_VECTOR_COPIES void powers(const float* values, Sums& sums, std::size_t size) {
  add_powers(values, sums, size);
}
ASSAY_VECTOR_COPIES void powers(const double* values, Sums& sums, std::size_t size) {
  add_powers(values, sums, size);
}

template <class Real>
void moments_of_block(const ImageStack<Real>& stack, std::size_t first, std::span<Moments> out) {
  Sums sums;
  const double count = static_cast<double>(stack.images.size());
  const Real* const origin = stack.at(0, first);
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    differences(stack.at(r, first), origin, sums.mean.data(), out.size());
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double value = static_cast<double>(origin[i]);
    sums.mean[i] = value + sums.mean[i] / count;
    sums.minimum[i] = value;
    sums.maximum[i] = value;
  }
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    powers(stack.at(r, first), sums, out.size());
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {.count = stack.images.size(),
              .mean = sums.mean[i],
              .m2 = sums.m2[i],
              .m3 = sums.m3[i],
              .m4 = sums.m4[i],
              .minimum = sums.minimum[i],
              .maximum = sums.maximum[i],
              .nonzero = static_cast<std::uint64_t>(sums.nonzero[i])};
  }
}

}  // namespace

template <class Real>
void element_moments(const ImageStack<Real>& stack, std::size_t first, std::span<Moments> out) {
  check::at_least({"element_moments", "images"}, stack.images.size(), 1);
  for (const auto& image : stack.images) {
    check::at_least({"element_moments", "size of an image"}, image.size() + stack.there.first,
                    first + out.size());
  }
  for (std::size_t done = 0; done < out.size(); done += block_size) {
    const std::size_t size = std::min(block_size, out.size() - done);
    moments_of_block(stack, first + done, out.subspan(done, size));
  }
}

template void element_moments(const ImageStack<float>&, std::size_t, std::span<Moments>);
template void element_moments(const ImageStack<double>&, std::size_t, std::span<Moments>);

}  // namespace assay::stats
