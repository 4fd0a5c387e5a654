#pragma once

// The scene before a lens: rectangles that face it, at several depths, plain or with a sinusoid of
// radiance across them.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "estimators/core/value.h"
#include "estimators/cost.h"
#include "estimators/estimator.h"
#include "estimators/stream.h"
#include "render/hemisphere.h"
#include "render/scene.h"

namespace assay::depth_of_field {

// A thin lens in the plane z = 0 about the origin that looks along +z. Each point of a pixel's
// image is gathered over the whole lens. Points of the depth `focus` are sharp.
//
// A pixel is named by the point P of the plane z = focus that it sees. A ray from the lens point
// radius (u, v), |(u, v)| <= 1, goes through P. It meets the plane at depth z in
//   x = (1 - z / focus) radius u + z / focus P.x,   y likewise.
// The lens is seen there as the disc of confusion, of radius |1 - z / focus| radius.

struct Lens {
  double radius = 0;  ///< of the aperture
  double focus = 1;   ///< depth of what is sharp
};

/// A point of a plane of constant depth, or of the unit disc.
struct PlanePoint {
  double x = 0;
  double y = 0;
};

/// The map from lens points (unit disc) to points at one depth: x = scale u + offset.x.
struct Footprint {
  double scale = 0;  ///< negative behind the focal plane; its size is the radius of confusion
  PlanePoint offset;

  PlanePoint at(const PlanePoint& u) const {
    return {scale * u.x + offset.x, scale * u.y + offset.y};
  }
};

inline Footprint footprint(const Lens& lens, const PlanePoint& pixel, double depth) {
  const double magnified = depth / lens.focus;
  return {(1 - magnified) * lens.radius, {magnified * pixel.x, magnified * pixel.y}};
}

/// From the lens point through the pixel's point of the focal plane; t is depth / focus.
inline render::Ray lens_ray(const Lens& lens, const PlanePoint& pixel, const PlanePoint& u) {
  const render::Vector3 from{lens.radius * u.x, lens.radius * u.y, 0};
  return {from, render::Vector3{pixel.x, pixel.y, lens.focus} - from};
}

/// A point uniform on the unit disc from two numbers uniform on [0, 1). The radius is the root of
/// the first, so that equal areas are equally probable.
struct UniformDisc {
  PlanePoint operator()(double s, double t) const {
    const double radius = std::sqrt(s);
    const auto [x, y] = render::on_unit_circle(t);
    return {radius * x, radius * y};
  }
};

/// A point of the lens, from two numbers of the stream. `Disc` maps them to the unit disc.
template <class Disc = UniformDisc>
PlanePoint lens_point(Stream& random) {
  const double s = random.uniform();
  return Disc{}(s, random.uniform());
}

/// Lens points lifted to the hemisphere above the unit disc, (u, v, sqrt(1 - u^2 - v^2)). Points
/// uniform on the disc become directions of density cos(theta) / pi (Malley's method, backwards).
template <class Disc = UniformDisc>
std::vector<NamedSampler> lens_samplers() {
  const auto point = [](Stream& random) {
    const PlanePoint u = lens_point<Disc>(random);
    return Point{u.x, u.y, std::sqrt(std::max(0.0, 1 - u.x * u.x - u.y * u.y))};
  };
  const auto density = [](const Point& w) { return std::max(0.0, w[2]) / std::numbers::pi; };
  return {{"lens", sampler_of({Domain::hemisphere, point, density})}};
}

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
