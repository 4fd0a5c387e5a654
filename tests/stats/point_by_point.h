#pragma once

#include "stats/cells/adaptive_cells.h"

namespace assay::tests {

// A density of two numbers as one of many points.
template <class Density>
stats::PlaneValues point_by_point(Density density) {
  return [density](std::span<const double> x, std::span<const double> y, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = density(x[i], y[i]);
  };
}

template <class Density>
stats::PlaneDensity on_unit_square(Density density, stats::Panelling panels = {}) {
  return {.x = {0, 1},
          .y = {0, 1},
          .values = point_by_point(density),
          .x_panels = panels,
          .y_panels = panels};
}

inline std::vector<double> even_borders(std::size_t cells) {
  std::vector<double> borders;
  for (std::size_t k = 0; k <= cells; ++k) {
    borders.push_back(static_cast<double>(k) / static_cast<double>(cells));
  }
  return borders;
}

inline stats::PlaneGrid unit_grid(std::size_t rows, std::size_t columns) {
  return {even_borders(rows), even_borders(columns)};
}

}  // namespace assay::tests
