#pragma once

// Seeds for programs that take a positive 31-bit integer.

#include <cstdint>
#include <map>
#include <mutex>

#include "estimators/stream.h"

namespace assay::foreign {

inline constexpr std::uint64_t render_seeds = 0x7fffffff;  ///< 2^31 - 1, a prime: seeds 1 to this

/// The first seed of a stream, before seeds are scattered.
constexpr std::uint64_t first_render_seed(StreamKey key) { return key.bits % render_seeds; }

/// The seed of one observation: 1 + a (key + observation) mod p, with p = 2^31 - 1. The multiplier
/// a = 630360016 is that of Payne, Rabung and Bogyo (1969). Multiplying is one-to-one: the first p
/// observations of a stream have different seeds. Neighbours have seeds far apart.
constexpr std::uint32_t render_seed(StreamKey key, std::uint64_t observation) {
  const std::uint64_t place = (first_render_seed(key) + observation % render_seeds) % render_seeds;
  return static_cast<std::uint32_t>(1 + 630360016 * place % render_seeds);
}

/// The seeds that streams have used in this process. Two streams of n and m observations meet by
/// chance with probability about (n + m) / 2^31. Their pictures would then be the same.
class SeedLedger {
 public:
  /// Notes an observation. Throws std::runtime_error where its seed is another stream's.
  void note(StreamKey key, std::uint64_t observation);

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, std::uint64_t> counts_;  ///< of each key, observations up to the last
};

}  // namespace assay::foreign
