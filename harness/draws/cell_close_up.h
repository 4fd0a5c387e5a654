#pragma once

// Where a density's mass lies close together: its cells as large as they are, not as large as the
// grid's.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/draws/density_cells.h"

namespace assay::harness {

/// Points of a rectangle, side times side of them, row by row, each with the residual of the cell
/// that it lies in.
struct CloseUp {
  std::string axes;  ///< what rows and columns are
  std::size_t side = 0;
  std::vector<double> z = {};
};

/// The rectangle around the cells that have at least half of the heaviest one's mass; an azimuth
/// may go on beyond 2 pi. Of several lobes the cell that is farthest off, 0 in a cell without a
/// residual. `z`: of each cell in the domain. Nothing where no cell in the rectangle has one, and
/// where the rectangle is an eighth of all coordinates or more: the grid shows it.
std::optional<CloseUp> close_up(const DensityCells& density, const Sampler& sampler,
                                std::span<const std::optional<double>> z);

}  // namespace assay::harness
