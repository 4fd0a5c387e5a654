#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/images/image.h"

namespace assay::stats {

// Mean and sum of squared deviations of each element over the replicates of an image. Values are
// floats or doubles, sums are doubles. Elements do not mix, so a caller may split them among
// threads and the bits stay the same.
struct ImageMoments {
  std::uint64_t count = 0;
  std::vector<double> mean;
  std::vector<double> m2;

  explicit ImageMoments(std::size_t elements) : mean(elements), m2(elements) {}

  // Adds one replicate (Welford 1962). Throws std::domain_error for a wrong size.
  template <class Real>
  void add(std::span<const Real> image);

  // Same as adding the other's replicates here (Chan, Golub & LeVeque 1983). Merging in a fixed
  // order gives fixed bits. Throws std::domain_error for a wrong size.
  void merge(const ImageMoments& other);

  // Squared standard error of the mean of one element, m2 / (count (count - 1)).
  double squared_error(std::size_t element) const;
};

// Views of two arrays of one size that receive the moments of a range of elements.
struct MomentArrays {
  std::span<double> mean;
  std::span<double> m2;
};

// Moments of the elements [first, first + mean.size()) over the images start, start + step, start +
// 2 step, … All are in memory. Deviations are taken from the first of these images. It belongs to
// the sample, so sum d^2 <= (n + 1) m2 and subtracting costs at most n + 1 roundings. So m2 is
// exactly zero for constants and only for them.
struct EveryImage {
  std::size_t start = 0;
  std::size_t step = 1;
};
template <class Real>
void moments_of_range(const ImageStack<Real>& stack, std::size_t first, MomentArrays out,
                      EveryImage which = {});

}  // namespace assay::stats
