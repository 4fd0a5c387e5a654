#pragma once

// Cells of a sampler's domain, and what its density says of them.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/sampler.h"
#include "stats/basics/adaptive_quadrature.h"
#include "stats/cells/adaptive_cells.h"

namespace assay::harness {

/// Cells in the chart of the domain: 16 x 32, of an interval 64. An interval with fewer
/// doubles has a cell for each. Each border lies beside that of equal measure (solid angle, area)
/// at random, by one cell at most. Borders beyond an end come back as far inside. A defect that
/// repeats itself from cell to cell, such as a coarse rounding, would leave equal cells alone.
stats::PlaneGrid shifted_grid(const Sampler& sampler, StreamKey key);

/// The cells of all lobes in turn, then one for each point mass, then one for draws without a
/// point.
class DrawCells {
 public:
  /// Every lobe has the same cells, of equal measure. Keeps a reference to the sampler.
  explicit DrawCells(const Sampler& sampler);
  /// Gives each lobe its own cells.
  DrawCells(const Sampler& sampler, std::vector<stats::HalvedCells> of_lobes);

  std::size_t size() const { return lobes_end_ + point_masses_.size() + 1; }
  /// The cell of a draw that is sound().
  std::size_t index(const SamplerDraw& draw) const;
  /// "theta 0.1 to 0.2, phi 0 to 0.196"; with several lobes also the lobe.
  std::string describe(std::size_t cell) const;
  /// The number of cells that are parts of a domain, which come first.
  std::size_t in_domain() const { return lobes_end_; }
  const stats::PlaneGrid& grid() const { return of_lobes_.front().grid; }
  /// The grid's cell that contains it.
  std::size_t grid_cell(std::size_t cell) const;
  /// The cell's bounds in cell_coordinates().
  stats::PlaneCell sides(std::size_t cell) const;

 private:
  struct Found {
    std::size_t lobe;
    std::size_t cell;
  };
  Found found(std::size_t cell) const;

  const Sampler& sampler_;
  std::vector<stats::HalvedCells> of_lobes_;
  std::vector<std::size_t> begin_;  ///< number of each lobe's first cell
  std::size_t lobes_end_ = 0;
  std::vector<int> point_masses_;  ///< their lobes
};

/// The marginals of the domain; for an interval with its bounds.
std::vector<Marginal> marginals_of(const Sampler& sampler);

/// The coordinates of cells. They are the marginals, except that a triangle's second is v / (1 -
/// u).
std::vector<Marginal> cell_coordinates(const Sampler& sampler);

/// The draw, with a point that lies outside the domain by rounding moved to the border. Rounding is
/// 1e-6 of the domain's size or the sampler's rounding(), whichever is more. Throws
/// std::runtime_error, in words for the sampler's author, if the point is farther outside, the
/// density is below 0, or the lobe does not exist. It also throws if a direction's length is not 1
/// within 1e-4 or rounding().
SamplerDraw sound(const NamedSampler& named, SamplerDraw draw);

/// The density at a point. Throws std::domain_error if it is negative or not finite.
double sound_density(const NamedSampler& named, const Point& point, double density);

/// A density at many points. A sampler may write only the first few, and returns how many. Throws
/// as sound_density().
using Densities = std::function<std::size_t(std::span<const Point>, std::span<double>)>;

void write_all(const Densities& densities, std::span<const Point> points, std::span<double> out);

/// True if the density is 0 at this point and around it, as no draw has it. Around is within 1e-6
/// of the domain's size, or the sampler's rounding() if that is more. Rounding may move a point so
/// far across an edge.
bool is_impossible(const Sampler& sampler, const Point& point, double density);

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
  std::vector<std::uint64_t> in_cells(std::span<const std::uint64_t> counts) const;
  /// Counts of draws where the density is 0, by their cells.
  std::span<const std::uint64_t> impossible(std::span<const std::uint64_t> counts) const {
    return counts.subspan(cells.size());
  }
  /// Probability of the draws that no marginal's density is about.
  double without_density() const { return missing() + point_masses; }
};

/// The law of marginal 0 or 1 by the density of all lobes together. `drawn` as for density_cells().
stats::TabulatedLaw law_of(const NamedSampler& named, std::size_t marginal,
                           std::span<const Point> drawn);

/// Computes them by quadrature, with the borders of this key. `drawn` are points of the sampler.
/// Throws std::domain_error if the density is negative or not finite.
DensityCells density_cells(const NamedSampler& named, StreamKey key, std::span<const Point> drawn);

}  // namespace assay::harness
