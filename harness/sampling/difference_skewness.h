#pragma once

#include <optional>
#include <span>

#include "stats/basics/moments.h"

namespace assay::harness {

/// One side: its moments over a pilot, the number of pilot observations that one replicate
/// averages, and its factor.
struct SkewedSide {
  stats::Moments pilot;
  double averaged = 1;
  double factor = 1;
};

/// |skewness| of one replicate's difference at an element; nullopt if nothing varies.
std::optional<double> difference_skewness(std::span<const SkewedSide> sides);

}  // namespace assay::harness
