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

// The cells of a grid, some of them halved, and some of their halves again. Together they are the
// grid. They are numbered in the grid's order, the lower half first. So neighbours in number are
// neighbours in place.
struct HalvedCells {
  // A cell of the grid, or a half of another.
  struct Node {
    std::size_t halves = 0;  // Place of its lower half, before the upper one; 0 if it is whole.
    bool along_x = true;
    double border = 0;       // A point on it is in the upper half.
    std::size_t number = 0;  // Of a whole one.
  };

  PlaneGrid grid;
  std::vector<Node> nodes;              // The grid's cells first.
  std::vector<PlaneCell> cells;         // The whole ones.
  std::vector<std::size_t> grid_cells;  // The grid's cell around each.

  std::size_t size() const { return cells.size(); }
  // Throws std::domain_error outside the grid.
  std::size_t index(double x, double y) const;
};

// Halves no cell. Throws std::domain_error if borders do not ascend.
HalvedCells whole_cells(const PlaneGrid& grid);

}  // namespace assay::stats
