#pragma once

// Whether a sampler's draws agree with what it declares, draw by draw, located by cell.

#include <optional>

#include "harness/draws/sampler_setup.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// How far a draw is from what its sampler declares, as the larger of two relative differences,
///   the draw's density from density(point), and weight x density(point) from evaluate(point);
/// that of a and b is |a - b| / max(|a|, |b|), 0 where they are equal. A draw that yields no point
/// must have weight 0, else it is infinitely far. 0 for the points of a lobe that is a point mass,
/// which have no density. NaN where one of the numbers is.
double inconsistency(const Sampler& sampler, const SamplerDraw& draw);

/// A sampler's draws as observations of a channel `inconsistent`: 0 for a draw no farther than the
/// sampler's rounding() from what it declares, else 1 + the number of its cell; and of a channel
/// `difference`, how far it is.
class ConsistencySetup final : public SamplerSetup {
 public:
  explicit ConsistencySetup(NamedSampler named);

  /// Of equal measure: where a draw is, whatever its density.
  const DrawCells& cells() const { return cells_; }

  std::vector<Channel> channels() const override;
  std::unique_ptr<Estimator> make() const override;

 private:
  DrawCells cells_;
};

inline const std::string inconsistent_channel = "inconsistent";

/// The number of the first inconsistent observation among the pool's first `count`, drawn again one
/// by one; nothing where there is none.
std::optional<std::uint64_t> first_inconsistent(const Pool& pool, std::uint64_t count);

/// What tells the streams of a sampler's consistency from those of its draws.
std::string consistency_purpose(const std::string& sampler);

std::shared_ptr<const SamplerSetup> consistency_setup(const NamedSampler& named,
                                                      const Location& where);

}  // namespace assay::harness
