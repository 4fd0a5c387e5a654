#pragma once

// A sampler's draws as observations: a channel for each marginal, and one for the number of the
// cell. Samplers are thus drawn, counted and replayed as estimators are.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/sampler.h"
#include "estimators/stream.h"
#include "harness/draws/draw_cells.h"

namespace assay::harness {

class Pool;

inline const std::string cell_channel = "cell";

/// The value of a marginal's channel for a draw without a point and for a point mass. It lies below
/// the marginal's range.
double no_point(const Marginal& marginal);

/// The value of the channel `cell` before density_cells() is called.
inline constexpr double no_cell = -1;

/// The density is out of reach: the program that computes it has ended.
struct NoDensity : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Draws of the first few streams.
std::vector<SamplerDraw> draws_of(const Sampler& sampler, std::span<const Stream> streams);

class SamplerSetup : public Setup {
 public:
  /// The key is that of the cells' borders and of the draws that show peaks of the density.
  /// InputError at `where` for a sampler without lobes, or an interval whose bounds are not finite
  /// and ascending.
  explicit SamplerSetup(NamedSampler named, const Location& where = {}, StreamKey key = {});

  std::size_t channel_count() const override { return marginals().size() + 1; }
  Channel channel(std::size_t place) const override;
  std::unique_ptr<Estimator> make() const override;

  /// Computed on first use, then kept. Throws NoDensity.
  const DensityCells& density_cells() const;
  /// The same, or null before density_cells() is called. The cells cost a quadrature that most
  /// claims do not need, so Pools calls density_cells() if a plan counts in cells. Estimators are
  /// made later.
  std::shared_ptr<const DensityCells> cells_asked_for() const;
  /// The marginal's law by the declared density, on first use, then kept. 1 - total() is the mass
  /// without a point. Throws NoDensity.
  const stats::TabulatedLaw& marginal_law(const std::string& marginal) const;
  const Sampler& sampler() const { return *named_.sampler; }
  const NamedSampler& named() const { return named_; }
  const std::string& name() const { return named_.name; }
  /// The marginals that have channels, the first ones.
  virtual std::vector<Marginal> marginals() const;
  /// How many numbers the channel has that is counted in cells. Throws NoDensity.
  virtual std::size_t cell_numbers() const { return density_cells().numbers(); }

 private:
  auto integrated(auto table) const;
  const std::vector<Point>& drawn() const;

  NamedSampler named_;
  StreamKey key_;
  mutable std::optional<std::vector<Point>> drawn_;
  mutable std::mutex once_;
  mutable std::shared_ptr<const DensityCells> cells_;
  mutable std::map<std::string, stats::TabulatedLaw> laws_;
  mutable std::string no_density_;
};

/// The set-up of a sampler with this key, shared by all callers so that tables are made once.
/// Throws as its constructor.
std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named, const Location& where,
                                                  StreamKey key = {});

/// The draw of observation `index` and what the sampler declares at its point, with all digits.
std::string draw_text(const Sampler& sampler, StreamKey key, std::uint64_t index);

/// A sampler's draws as observations of two channels. Channel `difference` is how far a draw is
/// from what its sampler declares. Channel `inconsistent` is 0 if that is at most the sampler's
/// rounding(), else 1 + the number of the draw's cell.
class ConsistencySetup final : public SamplerSetup {
 public:
  explicit ConsistencySetup(const NamedSampler& named, const Location& where = {});

  /// Cells of equal measure; they do not depend on the density.
  const DrawCells& cells() const { return cells_; }

  std::size_t channel_count() const override { return 2; }
  Channel channel(std::size_t place) const override;
  std::unique_ptr<Estimator> make() const override;
  std::vector<Marginal> marginals() const override { return {}; }
  std::size_t cell_numbers() const override { return 1 + cells_.size(); }

 private:
  DrawCells cells_;
};

inline const std::string inconsistent_channel = "inconsistent";

/// The first inconsistent observation among the pool's first `count`, and which numbers contradict
/// each other. It is found by drawing again.
std::optional<std::pair<std::uint64_t, std::string>> first_inconsistent(const Pool& pool,
                                                                        std::uint64_t count);

}  // namespace assay::harness
