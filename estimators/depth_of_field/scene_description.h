#pragma once

// The scene before a lens: rectangles that face it, at several depths, plain or with a sinusoid of
// radiance across them.

#include <memory>
#include <vector>

#include "depth_of_field/thin_lens.h"
#include "estimators/core/value.h"
#include "estimators/cost.h"

namespace assay::depth_of_field {

struct Interval {
  double low = 0;
  double high = 0;
  bool contains(double x) const { return low <= x && x <= high; }
};

/// Radiance mean + amplitude cos(frequency x + phase).
struct Texture {
  double mean = 0;
  double amplitude = 0;
  double frequency = 0;  ///< 2 pi / wavelength
  double phase = 0;

  double at(double x) const {
    return amplitude == 0 ? mean : mean + amplitude * std::cos(frequency * x + phase);
  }
};

/// A rectangle of constant depth with edges along x and y; stops light from behind.
struct Plane {
  double depth = 1;
  Interval x;
  Interval y;
  Texture texture;

  bool contains(const PlanePoint& p) const { return x.contains(p.x) && y.contains(p.y); }
};

struct SceneDescription {
  Lens lens;
  double background = 0;      ///< radiance of what no plane hides
  std::vector<Plane> planes;  ///< the nearest first

  /// The least and the largest radiance there is.
  Interval range() const;
};

/// Reads a scene: the name of a built-in one (edge, sinusoid, strip, portrait, boards), or a map
///  `lens:       {radius: .2, focus: 2}
///   background: .1                                      0 unless given
///   planes:     [{depth: 2, x: [-1, 1], y: [-1, 1], radiance: .6,
///                 amplitude: .3, wavelength: .15, phase: 0}]   a wave along x; may be left out`.
///
/// InputError at the offending node: an unknown or missing key, an unknown name, a number that is
/// not finite, a lens without extent. InputError, too, for a depth or focus that is not positive,
/// an empty range, and planes of one depth that overlap. InputError for an amplitude without a
/// wavelength, and for a radiance that is negative somewhere.
SceneDescription read_scene(const Value& value);

class Setting {
 public:
  explicit Setting(SceneDescription scene);

  const SceneDescription& scene() const { return scene_; }

  /// The first plane on the ray from the lens point (unit disc) through the pixel, or none.
  const Plane* first_hit(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const;

  /// The radiance that arrives at the lens point from the pixel. What is hit is Embree's to say
  /// (edges are off by about 1e-7 of their coordinates); where, is worked out in double precision.
  double radiance(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const {
    const Plane* const plane = first_hit(pixel, u, cost);
    if (!plane) return scene_.background;
    return plane->texture.at(footprint(scene_.lens, pixel, plane->depth).at(u).x);
  }

 private:
  SceneDescription scene_;
  render::Scene rays_;
};

using SharedSetting = std::shared_ptr<const Setting>;

}  // namespace assay::depth_of_field
