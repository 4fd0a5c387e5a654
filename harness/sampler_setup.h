#pragma once

// A sampler's draws as observations: one channel per marginal and one with the number of the cell
// that the point fell into. So samplers are drawn, counted and replayed like everything else.

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "stats/cells.h"
#include "stats/plane_cells.h"
#include "stats/tabulated_law.h"

namespace assay::harness {

inline const std::string cell_channel = "cell";

/// Cells of a sampler's domain on a fixed grid with the probability its declared density gives
/// each: the grid once for every lobe, then a cell for every lobe that is a point mass. One more
/// cell, the last, is the draws that yield no point.
struct DensityCells {
  stats::CellProbabilities grid;
  std::size_t size() const { return grid.probability.size() + 1; }
  /// What the quadrature may be off in all probability: twice the estimated error, and the rounding
  /// of a sum over the cells of a density that is right to some ten units in its last place.
  double tolerance() const;
  /// 1 minus the total, and exactly 0 where the tolerance could explain it.
  double missing() const;
  double point_masses = 0;  ///< part of the total
  /// missing() and the point masses: the draws that no marginal's density is about.
  double without_density() const { return missing() + point_masses; }
};

/// The value of a marginal's channel where a draw yields no point, or one of a point mass: below
/// the marginal's range.
double no_point(const Marginal& marginal);

/// That a sampler's density could not be asked for: the program that it is inside of has ended.
class NoDensity : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws of the first few of the streams.
std::vector<SamplerDraw> draws_of(const Sampler& sampler, std::span<Stream> streams);

class SamplerSetup : public Setup {
 public:
  explicit SamplerSetup(NamedSampler named);

  std::vector<Channel> channels() const override;
  std::unique_ptr<Estimator> make() const override;

  /// How many cells there are, the last for draws without a point.
  std::size_t cell_count() const;
  /// By quadrature of the declared density, on first use; then kept. Throws NoDensity.
  const DensityCells& cells() const;
  /// The law of a marginal under the declared density, given a point; 1 - total() is the mass
  /// without one. On first use; then kept. Throws NoDensity.
  const stats::TabulatedLaw& marginal_law(const std::string& marginal) const;
  const Sampler& sampler() const { return *named_.sampler; }
  const NamedSampler& named() const { return named_; }
  const std::string& name() const { return named_.name; }
  /// Of a domain of two coordinates the cells of one lobe.
  const stats::PlaneGrid& grid() const { return grid_; }
  std::vector<Marginal> marginals() const;

  /// Number of the cell of a draw that is sound().
  std::size_t cell(const SamplerDraw& draw) const;
  /// "theta 0.1 to 0.2, phi 0 to 0.196" of lobe 1, where there are several.
  std::string describe_cell(std::size_t cell) const;

 private:
  auto integrated(auto table) const;

  NamedSampler named_;
  stats::PlaneGrid grid_;  // of a domain of two coordinates
  mutable std::mutex once_;
  mutable std::shared_ptr<const DensityCells> cells_;
  mutable std::map<std::string, stats::TabulatedLaw> laws_;
  mutable std::string no_density_;  ///< why
};

/// InputError at `where` for a sampler without lobes and for an interval whose bounds are not
/// finite and ascending.
void require_sound(const NamedSampler& named, const Location& where);

/// The same set-up for the same sampler, so that its tables are made once. Throws as
/// require_sound.
std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named, const Location& where);

}  // namespace assay::harness
