#pragma once

#include <span>

#include "stats/images/image.h"

namespace assay::stats {

// Views of two arrays of one size that receive the moments of a range of elements.
struct MomentArrays {
  std::span<double> mean;
  std::span<double> m2;
};

// Mean and sum of squared deviations of each of the elements [first, first + mean.size()) over the
// images start, start + step, start + 2 step, … All are in memory. Deviations are taken from the
// first of these images. It belongs to the sample, so sum d^2 <= (n + 1) m2 and subtracting costs
// at most n + 1 roundings. So m2 is exactly zero for constants and only for them.
struct EveryImage {
  std::size_t start = 0;
  std::size_t step = 1;
};
template <class Real>
void moments_of_range(const ImageStack<Real>& stack, std::size_t first, MomentArrays out,
                      EveryImage which = {});

}  // namespace assay::stats
