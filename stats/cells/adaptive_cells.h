#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "stats/basics/adaptive_quadrature.h"

namespace assay::stats {

// A density per dx dy on a rectangle. The panels say how finely it must be looked at. No feature
// lies between the nodes of that many equal panels. Jumps along lines of a coordinate lie on their
// borders.
struct PlaneDensity {
  Span x;
  Span y;
  PlaneValues values;
  Panelling x_panels = {};
  Panelling y_panels = {};
  std::vector<std::array<double, 2>> drawn = {};  // Values of the law, which show its peaks.
};

// The density of x alone: integrated over all of y. `density` must outlive the result.
AdaptiveQuadrature::Function marginal_density(const PlaneDensity& density,
                                              AdaptiveQuadrature& rule);

struct PlaneCell {
  Span x;
  Span y;
};

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

// The probability of each of some cells under a law.
struct CellProbabilities {
  std::vector<double> probability;
  std::vector<double> error;  // Estimated absolute error of each.
  double total = 0;           // Sum of probability. The rest to 1 is the mass of "no point".
  double total_error = 0;
};

// Cells that hold at most a share of a density's mass each. They depend on the density alone, never
// on data. A grid's heaviest cell is halved until none holds more, along the coordinate in which
// its mass lies closer together. So an even density keeps the grid's cells, and a narrow lobe gets
// cells of its own. A cell that was halved 48 times may hold more. So may one with no number
// between its ends, and any cell once the quadrature's evaluations are used up. A density of mass
// below 1 counts as a share of 1.
struct AdaptiveCells {
  HalvedCells cells;
  CellProbabilities mass;  // By quadrature, with its errors.
};

// Throws std::domain_error: borders that do not ascend, a share that is not in (0, 1], a density
// that is negative or not finite.
AdaptiveCells adaptive_cells(const PlaneGrid& grid, const PlaneDensity& density,
                             double largest_share, QuadratureLimits limits = {.tolerance = 1e-9});

// A density of one coordinate at many places, with its panels (see PlaneDensity).
struct LineDensity {
  std::function<void(std::span<const double> x, std::span<double> values)> values;
  Panelling panels = {};
};

// The same for an interval between these borders. The y of its cells is [0, 1].
AdaptiveCells adaptive_cells(const std::vector<double>& borders, const LineDensity& density,
                             double largest_share, QuadratureLimits limits = {.tolerance = 1e-9});

}  // namespace assay::stats
