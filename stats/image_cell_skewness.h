#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/for_each.h"
#include "stats/image.h"

namespace assay::stats {

// How far skewness moves the tails of the sums over cells that image_pyramid.h looks at, as a pilot
// shows it.
//
// One side of the comparison: pilot replicates, and the mean over later ones that is to be tested.
struct CellPilot {
  AnyImageStack stack;
  double factor = 1;      // the difference is the sum over the sides of factor * mean
  double replicates = 1;  // of the pilot's kind in that mean
};

struct CellTails {
  std::uint32_t size = 1;  // side of the cells; the longer side of the image at last
  double factor = 1;
  double scatter = 0;  // by so much the factor of a normal pilot exceeds 1 with probability 1e-4
};

// For each size of aligned cell, fine to coarse: the mean over its cells of cosh(g x^3 / 3), the
// factor by which both tails of a studentised sum at x together depart from nominal, g the skewness
// of its numerator (assumption_gates.h). The mean, since false alarms add up; x is where one cell
// must be to be found at `level`, by the share of its size (image_windows.h). Cells that never
// varied do not count.
//
// A cell's sum is weighted as in the test: by `weights` (those of cell_weights, if the test has
// them), or, where they are empty, as each half of the replicates weighs the other: as many images
// of the pilot as half a test has give the rest their weights, up to eight such choices averaged.
//
// The pilot's own scatter is divided out: a sample skewness has variance 6 / n at the normal law,
// and E cosh(c (g + error)) = cosh(c g) exp(c^2 var / 2). What is left of it is `scatter`, for one
// cell cosh(3.9 c sd) exp(-c^2 var / 2) - 1, a 1 / sqrt(cells) of it for their mean.
// Throws std::domain_error as image_stack does, for different extents, and for a level outside
// (0, 1), or weights of another number than the elements.
std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level,
                                  std::span<const double> weights = {},
                                  const ForEach& for_each = one_by_one);

// Weights for image_pyramid.h: 1 / sqrt of the difference's variance at each element, steadied by
// its 3 x 3 neighbours; 0 where nothing varied. Throws std::domain_error as cell_tails does.
std::vector<double> cell_weights(std::span<const CellPilot> sides);

}  // namespace assay::stats
