#pragma once

#include <cstddef>
#include <vector>

#include "stats/cells/cell_quadrature.h"

namespace assay::stats {

// Cells between lines of two coordinates, such as a hemisphere's polar angle and azimuth. The
// second runs fastest. Borders ascend strictly.
struct PlaneGrid {
  std::vector<double> x_borders;
  std::vector<double> y_borders;

  std::size_t rows() const { return x_borders.size() - 1; }
  std::size_t columns() const { return y_borders.size() - 1; }
  std::size_t size() const { return rows() * columns(); }
  // A cell is closed below and open above, the last one closed. Throws std::domain_error outside
  // the grid.
  std::size_t index(double x, double y) const;
  PlaneCell cell(std::size_t index) const;
};

// Throws std::domain_error if borders do not ascend.
void check_borders(const PlaneGrid& grid);

// Integral of the density over every cell. If a cell shows no density at its nodes but a neighbour
// does, its sides are searched (CellQuadrature::beside_support). Throws std::domain_error when a
// density is negative or not finite.
std::vector<Integral> integrals_over(const PlaneGrid& grid, CellQuadrature& quadrature);

}  // namespace assay::stats
