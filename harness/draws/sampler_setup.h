#pragma once

// A sampler's draws as observations: one channel per marginal and one with the number of the cell
// that the point fell into, once somebody has asked for the density's cells. So samplers are drawn,
// counted and replayed like everything else.

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "harness/draws/density_cells.h"
#include "stats/tails/tabulated_law.h"

namespace assay::harness {

inline const std::string cell_channel = "cell";

/// The value of a marginal's channel where a draw yields no point, or one of a point mass: below
/// the marginal's range.
double no_point(const Marginal& marginal);

/// The value of the channel `cell` before density_cells() was asked for: no number of a cell.
inline constexpr double no_cell = -1;

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

  /// Made on first use, then kept. Throws NoDensity.
  const DensityCells& density_cells() const;
  /// The same, or nothing where nobody has asked for them yet. They take a quadrature of a density
  /// that most claims are not about, so draws are counted in them only from then on: the plan of
  /// what is counted asks (Pools), and workers are made later.
  std::shared_ptr<const DensityCells> cells_asked_for() const;
  /// The law of a marginal under the declared density, given a point; 1 - total() is the mass
  /// without one. On first use; then kept. Throws NoDensity.
  const stats::TabulatedLaw& marginal_law(const std::string& marginal) const;
  const Sampler& sampler() const { return *named_.sampler; }
  const NamedSampler& named() const { return named_; }
  const std::string& name() const { return named_.name; }
  std::vector<Marginal> marginals() const;

 private:
  auto integrated(auto table) const;

  NamedSampler named_;
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
