#pragma once

// A thin lens in the plane z = 0 about the origin that looks along +z. Each point of a pixel's
// image is gathered over the whole lens. Points of the depth `focus` are sharp.
//
// A pixel is named by the point P of the plane z = focus that it sees. A ray from the lens point
// radius (u, v), |(u, v)| <= 1, goes through P. It meets the plane at depth z in
//   x = (1 - z / focus) radius u + z / focus P.x,   y likewise.
// The lens is seen there as the disc of confusion, of radius |1 - z / focus| radius.

#include <algorithm>
#include <cmath>

#include "estimators/estimator.h"
#include "estimators/stream.h"
#include "render/hemisphere.h"
#include "render/scene.h"

namespace assay::depth_of_field {

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

}  // namespace assay::depth_of_field
