#pragma once

#include <cstdint>

namespace assay {

/// The work of an observation, counted by the estimator. The caller measures seconds.
struct Cost {
  std::uint64_t camera_rays = 0;
  std::uint64_t closest_hit_rays = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t samples = 0;  ///< primary estimates

  std::uint64_t rays() const { return camera_rays + closest_hit_rays + shadow_rays; }

  Cost& operator+=(const Cost& other) {
    camera_rays += other.camera_rays;
    closest_hit_rays += other.closest_hit_rays;
    shadow_rays += other.shadow_rays;
    samples += other.samples;
    return *this;
  }
  bool operator==(const Cost&) const = default;
};

/// The argument of a call whose cost nobody counts.
class Uncounted {
 public:
  operator Cost&() { return cost_; }

 private:
  Cost cost_;
};

inline Cost operator-(const Cost& after, const Cost& before) {
  return {.camera_rays = after.camera_rays - before.camera_rays,
          .closest_hit_rays = after.closest_hit_rays - before.closest_hit_rays,
          .shadow_rays = after.shadow_rays - before.shadow_rays,
          .samples = after.samples - before.samples};
}

}  // namespace assay
