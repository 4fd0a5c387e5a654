#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "stats/cells/halved_cells.h"

namespace assay::stats {

// What a law gives each of some cells.
struct CellProbabilities {
  std::vector<double> probability;
  std::vector<double> error;  // estimated absolute error of each
  double total = 0;           // sum of probability: 1 minus it is the mass of "no point"
  double total_error = 0;
};

// Cells of no more than a share of a density's mass each, chosen from the density alone and never
// from data: those of a grid, the heaviest halved until none holds more, each along the coordinate
// in which its mass lies closer together (of an interval, its own). So a density that is about even
// over the grid is counted in the grid's cells, and a narrow lobe in its own. A cell stays whole,
// and may hold more, where it was halved 48 times, where no number lies between its ends, and once
// the quadrature's evaluations are used up. A density of mass below 1, one lobe of several, has its
// share of 1.
struct AdaptiveCells {
  HalvedCells cells;
  CellProbabilities mass;  // by quadrature, with its errors
};

// Throws std::domain_error: borders that do not ascend, a share that is not in (0, 1], a density
// that is negative or not finite.
AdaptiveCells adaptive_cells(const PlaneGrid& grid, const PlaneDensity& density,
                             double largest_share, QuadratureLimits limits = {.tolerance = 1e-9});

// A density of one coordinate at many places, and its panels (PlaneDensity).
struct LineDensity {
  std::function<void(std::span<const double> x, std::span<double> values)> values;
  std::size_t panels = 1;
};

// The same of an interval between these borders; y of its cells is [0, 1].
AdaptiveCells adaptive_cells(const std::vector<double>& borders, const LineDensity& density,
                             double largest_share, QuadratureLimits limits = {.tolerance = 1e-9});

}  // namespace assay::stats
