#pragma once

// An enlarged part of the domain, for densities whose mass lies close together.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/draws/density_cells.h"

namespace assay::harness {

/// The residuals at side x side points of a rectangle, row by row. A point has its cell's residual.
struct CloseUp {
  std::string axes;
  std::size_t side = 0;
  std::vector<double> z = {};
};

/// The rectangle around the cells that have at least half of the heaviest one's mass. An azimuth
/// may go on beyond 2 pi. `z` has the residual of each cell in the domain. With several lobes a
/// point shows the cell that is farthest off. A cell without a residual shows 0. nullopt if the
/// rectangle has no residual, or covers an eighth of the domain, which the grid shows.
std::optional<CloseUp> close_up(const DensityCells& density, const Sampler& sampler,
                                std::span<const std::optional<double>> z);

}  // namespace assay::harness
