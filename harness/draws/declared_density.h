#pragma once

// The density that a sampler declares, as stats integrates it.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "estimators/estimator.h"
#include "harness/draws/draw_cells.h"
#include "stats/cells/adaptive_cells.h"
#include "stats/cells/cell_quadrature.h"

namespace assay::harness {

/// A density at many points. A sampler may write only the first few, and returns how many. Throws
/// as sound_density().
using Densities = std::function<std::size_t(std::span<const Point>, std::span<double>)>;

/// Asks until every point has its density.
void write_all(const Densities& densities, std::span<const Point> points, std::span<double> out);

/// The density of all lobes together. Keeps a reference to the sampler's name.
Densities densities_of(const NamedSampler& named);

/// Points that a sampler draws show the quadrature where its density has peaks.
stats::LineDensity line_density(const Sampler& sampler, std::span<const Point> drawn,
                                Densities densities);

/// True if the density is 0 at this point and around it, as no draw has it. Around is within 1e-6
/// of the domain's size, or the sampler's rounding() if that is more. Rounding may move a point so
/// far across an edge.
bool is_impossible(const Sampler& sampler, const Point& point, double density);

/// The density on a domain of two coordinates, in its chart by this marginal, 0 or 1. It asks for
/// the sampler's panels, halved as often as they cost too much. Bisection then finds jumps inside
/// panels.
stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  std::span<const Point> drawn, Densities densities);

/// Cells of a sampler's domain with the probability that the declared density gives each. Cells of
/// nearly equal measure, with borders from the suite's seed (shifted_grid), are halved until none
/// has more than 1/40 (1/32 on an interval). The quadrature's evaluations limit this
/// (stats/cells/adaptive_cells.h). Each lobe has its own cells; a point mass is one cell. The last
/// cell, draws without a point, has no probability here.
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
