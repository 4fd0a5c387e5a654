#pragma once

// Counts draws in cells, to compare them with their sampler's density.

#include "harness/draws/draw_cells.h"
#include "stats/cells/adaptive_cells.h"

namespace assay::harness {

/// Cells of a sampler's domain with the probability that the declared density gives each. Cells of
/// equal measure (measure_grid) are halved until none has more than 1/40 (1/32 on an interval). The
/// quadrature's evaluations limit this (stats/adaptive_cells.h). Each lobe has its own cells; a
/// point mass is one cell. The last cell, draws without a point, has no probability here.
struct DensityCells {
  DrawCells cells;
  stats::CellProbabilities mass;
  double point_masses = 0;  ///< part of the total

  /// The largest plausible error of the total: twice the quadrature's estimate, and the rounding of
  /// the sum.
  double tolerance() const;
  /// 1 - total; exactly 0 if the tolerance could explain it.
  double missing() const;
  /// Probability of the draws that no marginal's density is about.
  double without_density() const { return missing() + point_masses; }
};

/// Computes them by quadrature. Throws std::domain_error if the density is negative or not finite.
DensityCells density_cells(const NamedSampler& named);

}  // namespace assay::harness
