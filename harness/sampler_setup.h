#pragma once

// A sampler's draws as observations: one channel per marginal and one with the number of the cell
// that the point fell into. So samplers are drawn, counted and replayed like everything else.

#include <memory>
#include <string>

#include "estimators/estimator.h"
#include "stats/cells.h"

namespace assay::harness {

inline const std::string cell_channel = "cell";

/// Cells of a sampler's domain on a fixed grid, with the probability its declared density gives
/// each. The last cell is the draws that yield no point: 1 minus the density's integral.
struct DensityCells {
  stats::CellProbabilities grid;
  std::size_t size() const { return grid.probability.size() + 1; }
};

/// The value of a marginal's channel where a draw yields no point: below the marginal's range.
double no_point(const Marginal& marginal);

class SamplerSetup final : public Setup {
 public:
  explicit SamplerSetup(NamedSampler named);

  std::vector<Channel> channels() const override;
  std::unique_ptr<Estimator> make() const override;

  /// By quadrature of the declared density, on first use.
  const DensityCells& cells() const;
  /// P(marginal <= x | a point) under the declared density: a table of 1024 cells, linear between.
  std::function<double(double)> marginal_cdf(const std::string& marginal) const;
  const Sampler& sampler() const { return *named_.sampler; }
  std::vector<Marginal> marginals() const;

  /// Number of the cell of a draw.
  std::size_t cell(const SamplerDraw& draw) const;

 private:
  NamedSampler named_;
  mutable std::shared_ptr<const DensityCells> cells_;
};

/// InputError at `where` for a domain that has no cells here (square, triangle, sphere).
std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named, const Location& where);

}  // namespace assay::harness
