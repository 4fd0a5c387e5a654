#pragma once

// Tests draw by draw that a sampler agrees with what it declares, and where it does not.

#include <optional>

#include "harness/draws/sampler_setup.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

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

/// Keeps a sampler's consistency and its draws on different streams.
std::string consistency_purpose(const std::string& sampler);

}  // namespace assay::harness
