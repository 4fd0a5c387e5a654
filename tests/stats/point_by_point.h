#pragma once

#include <cstddef>
#include <span>

#include "stats/cells/cell_quadrature.h"

namespace assay::tests {

// A density of two numbers as one of many points.
template <class Density>
stats::PlaneValues point_by_point(Density density) {
  return [density](std::span<const double> x, std::span<const double> y, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = density(x[i], y[i]);
  };
}

}  // namespace assay::tests
