#pragma once

// A sampler's draws as observations: a channel for each marginal, and one for the number of the
// cell. Samplers are thus drawn, counted and replayed as estimators are.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "harness/draws/declared_density.h"
#include "harness/draws/density_cells.h"
#include "stats/tails/tabulated_law.h"

namespace assay::harness {

inline const std::string cell_channel = "cell";

/// The value of a marginal's channel for a draw without a point and for a point mass. It lies below
/// the marginal's range.
double no_point(const Marginal& marginal);

/// The value of the channel `cell` before density_cells() is called.
inline constexpr double no_cell = -1;

/// The density is out of reach: the program that computes it has ended.
class NoDensity : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws of the first few streams.
std::vector<SamplerDraw> draws_of(const Sampler& sampler, std::span<const Stream> streams);
/// The same before the first unsound draw. Throws if the first is unsound.
std::vector<SamplerDraw> sound_draws(const NamedSampler& named, std::span<const Stream> streams);
/// Writes numbers at the first points, as many as can be had, and returns how many. Throws if the
/// first has none. `numbers` writes some and returns how many.
std::size_t write_some(std::span<const Point> points, std::span<double> out,
                       const Densities& numbers);

/// The number of leading draws that can be judged. Those at `places` need numbers, which `ask` has
/// written for the first of them, and says how many. Throws if it is 0.
std::size_t leading(std::span<const std::size_t> places, std::size_t draws,
                    const std::function<std::size_t()>& ask);

class SamplerSetup : public Setup {
 public:
  /// The key is that of the cells' borders and of the draws that show peaks of the density.
  explicit SamplerSetup(NamedSampler named, StreamKey key = {});

  std::vector<Channel> channels() const override;
  std::unique_ptr<Estimator> make() const override;

  /// Computed on first use, then kept. Throws NoDensity.
  const DensityCells& density_cells() const;
  /// The same, or null before density_cells() is called. The cells cost a quadrature that most
  /// claims do not need, so Pools calls density_cells() if a plan counts in cells. Workers are made
  /// later.
  std::shared_ptr<const DensityCells> cells_asked_for() const;
  /// The marginal's law by the declared density, on first use, then kept. 1 - total() is the mass
  /// without a point. Throws NoDensity.
  const stats::TabulatedLaw& marginal_law(const std::string& marginal) const;
  const Sampler& sampler() const { return *named_.sampler; }
  const NamedSampler& named() const { return named_; }
  const std::string& name() const { return named_.name; }
  std::vector<Marginal> marginals() const;

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

/// InputError at `where` for a sampler without lobes, or an interval whose bounds are not finite
/// and ascending.
void require_sound(const NamedSampler& named, const Location& where);

/// The set-up of a sampler with this key, shared by all callers so that tables are made once.
/// Throws as require_sound.
std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named, const Location& where,
                                                  StreamKey key = {});

}  // namespace assay::harness
