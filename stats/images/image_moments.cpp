#include "stats/images/image_moments.h"

#include <algorithm>
#include <array>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

// The sums of this many elements stay in the first-level cache while the images pass by.
constexpr std::size_t block_size = 1024;

struct Sums {
  double* sum;
  double* squares;
};

// Four images a pass: sums are loaded and stored once for all four.
template <class Real>
struct FourImages {
  const Real* origin;
  std::array<const Real*, 4> image;
};

template <class Real>
inline void add_four(const FourImages<Real>& from, Sums to, std::size_t size) {
  const Real* const origin = from.origin;
  const Real* const a = from.image[0];
  const Real* const b = from.image[1];
  const Real* const c = from.image[2];
  const Real* const d = from.image[3];
  double* const __restrict sum = to.sum;
  double* const __restrict squares = to.squares;
  for (std::size_t i = 0; i < size; ++i) {
    const double zero = static_cast<double>(origin[i]);
    const double p = static_cast<double>(a[i]) - zero;
    const double q = static_cast<double>(b[i]) - zero;
    const double r = static_cast<double>(c[i]) - zero;
    const double s = static_cast<double>(d[i]) - zero;
    sum[i] += (p + q) + (r + s);
    squares[i] += (p * p + q * q) + (r * r + s * s);
  }
}

ASSAY_VECTOR_COPIES void add_four_images(const FourImages<float>& from, Sums to, std::size_t size) {
  add_four(from, to, size);
}
ASSAY_VECTOR_COPIES void add_four_images(const FourImages<double>& from, Sums to,
                                         std::size_t size) {
  add_four(from, to, size);
}

// The origin itself, which adds nothing, fills up the last four images.
template <class Real>
std::size_t moments_of_block(const ImageStack<Real>& stack, std::size_t first, MomentArrays out,
                             EveryImage which) {
  std::array<double, block_size> sum{};
  std::array<double, block_size> squares{};
  const std::size_t size = out.mean.size();
  const auto& images = stack.images;
  const Real* const origin = stack.at(which.start, first);
  std::size_t count = 1;
  for (std::size_t i = which.start + which.step; i < images.size();) {
    FourImages<Real> four{origin, {origin, origin, origin, origin}};
    for (std::size_t k = 0; k < 4 && i < images.size(); ++k, i += which.step, ++count) {
      four.image[k] = stack.at(i, first);
    }
    add_four_images(four, {sum.data(), squares.data()}, size);
  }
  const double inverse = 1 / static_cast<double>(count);
  for (std::size_t i = 0; i < size; ++i) {
    const double step = sum[i] * inverse;
    out.mean[i] = static_cast<double>(origin[i]) + step;
    out.m2[i] = std::max(squares[i] - sum[i] * step, 0.0);
  }
  return count;
}

}  // namespace

template <class Real>
void moments_of_range(const ImageStack<Real>& stack, std::size_t first, MomentArrays out,
                      EveryImage which) {
  for (std::size_t done = 0; done < out.mean.size(); done += block_size) {
    const std::size_t size = std::min(block_size, out.mean.size() - done);
    moments_of_block(stack, first + done,
                     {out.mean.subspan(done, size), out.m2.subspan(done, size)}, which);
  }
}

template void moments_of_range(const ImageStack<float>&, std::size_t, MomentArrays, EveryImage);
template void moments_of_range(const ImageStack<double>&, std::size_t, MomentArrays, EveryImage);

}  // namespace assay::stats
