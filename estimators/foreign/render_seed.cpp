#include "estimators/foreign/render_seed.h"

#include <stdexcept>
#include <string>

namespace assay::foreign {

void SeedLedger::note(StreamKey key, std::uint64_t observation) {
  const std::scoped_lock lock(mutex_);
  std::uint64_t& count = counts_[key.bits];
  if (observation < count) return;
  if (observation >= render_seeds) {
    throw std::runtime_error("there are no more than 2^31 - 1 seeds for observations");
  }
  count = observation + 1;
  const std::uint64_t begin = first_render_seed(key);
  for (const auto& [other, length] : counts_) {
    if (other == key.bits) continue;
    // Two arcs of a circle meet where one begins within the other.
    const std::uint64_t there = first_render_seed({other});
    const std::uint64_t ahead = (there + render_seeds - begin) % render_seeds;
    const std::uint64_t behind = (begin + render_seeds - there) % render_seeds;
    if (ahead >= count && behind >= length) continue;
    throw std::runtime_error(
        "observation " + std::to_string(observation) +
        " would have a seed that another estimator of this run has used, and the pictures would "
        "not be independent; choose another --seed");
  }
}

}  // namespace assay::foreign
