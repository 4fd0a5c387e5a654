#pragma once

// Counts draws in cells, to compare them with their sampler's density.

#include <cstdint>
#include <span>
#include <vector>

#include "harness/draws/draw_cells.h"
#include "stats/cells/adaptive_cells.h"

namespace assay::harness {

/// Cells of a sampler's domain with the probability that the declared density gives each. Cells of
/// nearly equal measure, with borders from the suite's seed (shifted_grid), are halved until none
/// has more than 1/40 (1/32 on an interval). The quadrature's evaluations limit this
/// (stats/adaptive_cells.h). Each lobe has its own cells; a point mass is one cell. The last cell,
/// draws without a point, has no probability here.
///
/// A draw where the density is 0 has a number of its own: that of its cell, plus the number of
/// cells.
struct DensityCells {
  DrawCells cells;
  stats::CellProbabilities mass;
  double point_masses = 0;  ///< part of the total

  /// The largest plausible error of the total: eight times the quadrature's estimate, which corners
  /// of a support exceed fourfold, and the rounding of the sum.
  double tolerance() const;
  /// 1 - total; exactly 0 if the tolerance could explain it.
  double missing() const;
  /// The cells and, behind them, those of draws where the density is 0.
  std::size_t numbers() const { return 2 * cells.size(); }
  /// Counts of the cells alone.
  std::vector<std::uint64_t> in_cells(std::span<const std::uint64_t> counts) const;
  /// Counts of draws where the density is 0, by their cells.
  std::span<const std::uint64_t> impossible(std::span<const std::uint64_t> counts) const {
    return counts.subspan(cells.size());
  }
  /// Probability of the draws that no marginal's density is about.
  double without_density() const { return missing() + point_masses; }
};

/// Computes them by quadrature, with the borders of this key. `drawn` are points of the sampler.
/// Throws std::domain_error if the density is negative or not finite.
DensityCells density_cells(const NamedSampler& named, StreamKey key, std::span<const Point> drawn);

}  // namespace assay::harness
