#pragma once

// How skewed the difference of two images is at one element.

#include <optional>
#include <span>

#include "stats/basics/moments.h"

namespace assay::harness {

/// One side of it: moments over a pilot, which one replicate averages so many of, times the factor.
struct SkewedSide {
  stats::Moments pilot;
  double averaged = 1;
  double factor = 1;
};

/// |skewness of one replicate's difference|; nullopt where nothing varies.
std::optional<double> difference_skewness(std::span<const SkewedSide> sides);

}  // namespace assay::harness
