#pragma once

// Cells that a sampler's draws are counted in.

#include <cstddef>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "stats/cells/halved_cells.h"

namespace assay::harness {

/// Cells of equal measure: 16 x 32 of two coordinates (domain_chart.h), 64 of an interval, or as
/// many as there are numbers between its ends.
stats::PlaneGrid measure_grid(const Sampler& sampler);

/// The cells of every lobe, one lobe's behind another's, then one for every lobe that is a point
/// mass; the last is the draws that yield no point.
class DrawCells {
 public:
  /// The same grid for every lobe. Keeps a reference to the sampler.
  explicit DrawCells(const Sampler& sampler);
  /// Each lobe's own.
  DrawCells(const Sampler& sampler, std::vector<stats::HalvedCells> of_lobes);

  std::size_t size() const { return lobes_end_ + point_masses_.size() + 1; }
  /// Number of the cell of a draw that is sound().
  std::size_t index(const SamplerDraw& draw) const;
  /// "theta 0.1 to 0.2, phi 0 to 0.196" of lobe 1, where there are several.
  std::string describe(std::size_t cell) const;
  /// How many are parts of a domain, from number 0 on.
  std::size_t in_domain() const { return lobes_end_; }
  /// The cell of measure_grid() that one of them is part of.
  std::size_t grid_cell(std::size_t cell) const;
  /// Where one of them lies, in cell_coordinates().
  stats::PlaneCell sides(std::size_t cell) const;
  /// Each lobe's at this place. Throws std::domain_error outside the grid.
  std::vector<std::size_t> at(double x, double y) const;

 private:
  /// One of a lobe's cells.
  struct Found {
    std::size_t lobe;
    std::size_t cell;
  };
  Found found(std::size_t cell) const;

  const Sampler& sampler_;
  std::vector<stats::HalvedCells> of_lobes_;
  std::vector<std::size_t> begin_;  ///< number of each lobe's first cell
  std::size_t lobes_end_ = 0;
  std::vector<int> point_masses_;  ///< lobes
};

/// The marginals of a sampler's domain; of an interval within its bounds.
std::vector<Marginal> marginals_of(const Sampler& sampler);

/// "theta 0.1 to 0.2", with as many digits as tell the ends apart.
std::string range_text(const std::string& name, stats::Span span);

/// The coordinates of cells: the marginals, but of a triangle the second is a share of what the
/// first leaves.
std::vector<Marginal> cell_coordinates(const Sampler& sampler);

}  // namespace assay::harness
