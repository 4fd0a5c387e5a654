#pragma once

#include <functional>
#include <span>
#include <vector>

#include "stats/cells/plane_cells.h"

namespace assay::stats {

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
