#pragma once

// The cells that draws are counted in to hold them against their sampler's density.

#include "harness/draws/draw_cells.h"
#include "stats/cells/adaptive_cells.h"

namespace assay::harness {

/// Cells of a sampler's domain with the probability its declared density gives each. Those of equal
/// measure (measure_grid) are halved until none has more than 1/40 (1/32 on an interval), as far as
/// the quadrature's evaluations reach (stats/adaptive_cells.h); of several lobes each has cells of
/// its own, and a lobe that is a point mass is one. The last cell is not among the probabilities:
/// draws that yield no point.
struct DensityCells {
  DrawCells cells;
  stats::CellProbabilities mass;
  double point_masses = 0;  ///< part of the total

  /// What the quadrature may be off in all probability: twice the estimated error, and the rounding
  /// of a sum over the cells of a density that is right to some ten units in its last place.
  double tolerance() const;
  /// 1 minus the total, and exactly 0 where the tolerance could explain it.
  double missing() const;
  /// missing() and the point masses: the draws that no marginal's density is about.
  double without_density() const { return missing() + point_masses; }
};

/// By quadrature. Throws std::domain_error where the density is negative or not finite.
DensityCells density_cells(const NamedSampler& named);

}  // namespace assay::harness
