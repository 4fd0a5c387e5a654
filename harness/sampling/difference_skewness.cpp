#include "harness/sampling/difference_skewness.h"

#include <cmath>

namespace assay::harness {
namespace {

struct Cumulants {
  double variance = 0;
  double third = 0;
};

/// Cumulants of one element of one replicate, times the factor.
Cumulants cumulants_of(const SkewedSide& side) {
  if (side.pilot.count < 3 || !(side.pilot.m2 > 0)) return {};
  const double factor = side.factor;
  const double variance = side.pilot.variance();
  const double third = side.pilot.skewness() * variance * std::sqrt(variance);
  return {factor * factor * variance / side.averaged,
          factor * factor * factor * third / (side.averaged * side.averaged)};
}

}  // namespace

std::optional<double> difference_skewness(std::span<const SkewedSide> sides) {
  Cumulants total;
  for (const SkewedSide& side : sides) {
    const Cumulants part = cumulants_of(side);
    total.variance += part.variance;
    total.third += part.third;
  }
  if (!(total.variance > 0)) return {};
  return std::abs(total.third) / (total.variance * std::sqrt(total.variance));
}

}  // namespace assay::harness
