#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "stats/cells/plane_cells.h"

namespace assay::harness {

/// Cells of equal measure: 16 x 32 for two coordinates (domain_chart.h), 64 for an interval. An
/// interval with fewer doubles has a cell for each.
stats::PlaneGrid measure_grid(const Sampler& sampler);

/// The same with each border moved at random, by one cell at most to either side. Borders beyond an
/// end come back as far inside. A defect that repeats itself from cell to cell, such as a coarse
/// rounding, would leave equal cells alone.
stats::PlaneGrid shifted_grid(const Sampler& sampler, StreamKey key);

/// The cells of all lobes in turn, then one for each point mass, then one for draws without a
/// point.
class DrawCells {
 public:
  /// Uses the same grid for every lobe. Keeps a reference to the sampler.
  explicit DrawCells(const Sampler& sampler);
  /// Gives each lobe its own cells.
  DrawCells(const Sampler& sampler, std::vector<stats::HalvedCells> of_lobes);

  std::size_t size() const { return lobes_end_ + point_masses_.size() + 1; }
  /// The cell of a draw that is sound().
  std::size_t index(const SamplerDraw& draw) const;
  /// "theta 0.1 to 0.2, phi 0 to 0.196"; with several lobes also the lobe.
  std::string describe(std::size_t cell) const;
  /// The number of cells that are parts of a domain; they come first.
  std::size_t in_domain() const { return lobes_end_; }
  /// The grid of all lobes.
  const stats::PlaneGrid& grid() const { return of_lobes_.front().grid; }
  /// The grid's cell that contains it.
  std::size_t grid_cell(std::size_t cell) const;
  /// The cell's bounds in cell_coordinates().
  stats::PlaneCell sides(std::size_t cell) const;
  /// The cell of each lobe at this place. Throws std::domain_error outside the grid.
  std::vector<std::size_t> at(double x, double y) const;

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

/// The marginals of a sampler's domain; for an interval with its bounds.
std::vector<Marginal> marginals_of(const Sampler& sampler);

/// "theta 0.1 to 0.2", with enough digits to tell the ends apart.
std::string range_text(const std::string& name, stats::Span span);

/// The coordinates of cells. They are the marginals, except that a triangle's second is v / (1 -
/// u).
std::vector<Marginal> cell_coordinates(const Sampler& sampler);

}  // namespace assay::harness
