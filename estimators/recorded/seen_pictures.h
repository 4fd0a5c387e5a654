#pragma once

// Which pictures were read: two that are the same bit for bit are one, and no two observations.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>

namespace assay::recorded {

/// Where a picture stands: an observation of a stream.
struct PictureName {
  std::uint64_t key = 0;
  std::uint64_t index = 0;
  bool operator==(const PictureName&) const = default;
};

class SeenPictures {
 public:
  /// Notes a picture by a digest of its texels (64 bits). Returns another one that had the same;
  /// nullopt where there is none, and for a picture of one value throughout, which noise may never
  /// have reached. Thread-safe.
  std::optional<PictureName> note(PictureName name, std::span<const float> texels);

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, PictureName> by_digest_;
};

}  // namespace assay::recorded
