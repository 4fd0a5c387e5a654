#pragma once

// Which pictures were read: two that are the same bit for bit are one, and no two observations.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

namespace assay::recorded {

class SeenPictures {
 public:
  /// Notes the picture of an observation by a digest of its texels (64 bits). Returns another one
  /// that had the same; nullopt where there is none, and for a picture of one value throughout,
  /// which noise may never have reached, or with texels that are not finite, whose observation is
  /// an error in itself. Thread-safe.
  std::optional<std::uint64_t> note(std::uint64_t index, std::span<const float> texels);

  /// Indices below `count` of a picture here and of one there that had the same digest, the first
  /// there; nullopt where no two do. Of what was noted so far: pictures of one value throughout,
  /// which are all alike without noise, count for nothing.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> shared_with(const SeenPictures& other,
                                                                     std::uint64_t count) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::uint64_t> by_digest_;
};

}  // namespace assay::recorded
