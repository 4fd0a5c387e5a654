#pragma once

// The worlds that paths run in, and rough estimates of the radiance that arrives there.

#include <cmath>
#include <vector>

#include "estimators/cost.h"
#include "estimators/stream.h"
#include "paths/scene_description.h"
#include "paths/zone_law.h"
#include "render/hemisphere.h"
#include "render/scene.h"
#include "render/share_table.h"
#include "render/vector.h"

namespace assay::paths {

/// The common parts of the two: the zones, and the point that the camera sees.
class Zones {
 public:
  Zones(const SphereScene& scene, const Camera& camera);

  const ZonedScene& law() const { return law_; }
  std::uint32_t at(double z) const {
    std::uint32_t index = 0;
    while (z > tops_[index]) ++index;
    return index;
  }
  Vertex vertex(const render::Vector3& position) const {
    const std::uint32_t index = at(position.z);
    return {position, -position, {}, &law_.zones[index].surface, index};
  }
  const render::Vector3& seen() const { return seen_; }

 private:
  std::vector<double> tops_;
  ZonedScene law_;
  render::Vector3 seen_;
};

/// The unit vector where a ray from inside the unit sphere, or from its surface, leaves it. It
/// solves |o + t d|^2 = 1 for d of unit length. From the surface the other root is 0, and saying so
/// is exact.
inline render::Vector3 exit_of_sphere(const render::Vector3& origin,
                                      const render::Vector3& direction, bool from_surface) {
  const double b = dot(origin, direction);
  const double t = from_surface ? -2 * b : -b + std::sqrt(b * b + 1 - squared_length(origin));
  // Normalised, so that rounding does not add up along a path.
  return normalised(origin + t * direction);
}

/// By rays: diffuse directions have the density cos / pi, whatever they hit.
class SphereWorld {
 public:
  SphereWorld(const SphereScene& scene, const Camera& camera)
      : zones_(scene, camera), mean_emission_(zones_.law().mean_emission()) {}

  const Zones& zones() const { return zones_; }

  Vertex camera(Cost& cost) const {
    ++cost.camera_rays;
    return zones_.vertex(zones_.seen());
  }
  /// `Random` gives uniform numbers: a stream, or the coordinates of a Markov chain.
  template <class Random>
  Vertex reflected(const Vertex& from, Random& random, Cost& cost) const {
    ++cost.closest_hit_rays;
    const double u = random.uniform();
    const double v = random.uniform();
    const render::Vector3 direction =
        render::Frame::about(from.normal).to_world(render::cosine_hemisphere(u, v));
    return zones_.vertex(exit_of_sphere(from.position, direction, true));
  }
  /// Zones have no mirrors.
  Vertex mirrored(const Vertex&, Cost&) const { return {}; }

  /// The direct light that v reflects: the irradiance over pi is the mean emission everywhere.
  Rgb direct_light(const Vertex& v, Direct direct, Stream& random, Cost& cost) const {
    if (direct == Direct::sampled) return sampled_light(v, random, cost);
    return v.surface->diffuse * mean_emission_;
  }

 private:
  /// Counts one shadow ray to a point uniform on the sphere, which is convex: nothing is between.
  /// The product of the cosines of two points over their squared distance is 1/4. With the area
  /// 4 pi and albedo / pi this leaves albedo x emission.
  Rgb sampled_light(const Vertex& v, Stream& random, Cost& cost) const {
    const double z = 2 * random.uniform() - 1;
    const Vertex light = zones_.vertex(render::direction_at(z, random.uniform()));
    if (light.surface->emission == Rgb{}) return {};
    ++cost.shadow_rays;
    return v.surface->diffuse * light.surface->emission;
  }

  Zones zones_;
  Rgb mean_emission_;
};

/// Without rays: the next vertex is a uniform point, as the hit of a cosine-distributed ray is.
class RayFreeWorld {
 public:
  RayFreeWorld(const SphereScene& scene, const Camera& camera) : zones_(scene, camera) {}

  Vertex camera(Cost&) const { return zones_.vertex(zones_.seen()); }
  Vertex reflected(const Vertex&, Stream& random, Cost&) const {
    return zones_.vertex({0, 0, 2 * random.uniform() - 1});
  }
  Vertex mirrored(const Vertex&, Cost&) const { return {}; }

 private:
  Zones zones_;
};

/// A path goes on from a point moved off its vertex, as a fraction of the radius of the triangle's
/// inscribed circle. The point moves by this fraction of the way to the circle's centre. It also
/// moves by a quarter of the fraction of the radius off the triangle. So it starts inside of
/// neighbours that meet at 15 degrees or more, and no ray slips out at an edge.
inline constexpr double mesh_resolution = 0x1p-14;
/// The least shift in units of the scene's longest side, 64 times the rounding of a coordinate. A
/// small triangle takes a larger fraction, half at most. So triangles do not leak if their
/// inscribed circles are larger than a 100000th of the scene.
inline constexpr double least_shift = 0x1p-18;

class MeshWorld {
 public:
  MeshWorld(const MeshScene& scene, const Camera& camera);

  /// The law of a furnace, as a scene of one zone.
  const ZonedScene& furnace() const { return furnace_; }
  /// Sides of triangles: 2 i is the side of triangle i that is seen counter-clockwise, 2 i + 1 the
  /// other.
  std::size_t patches() const { return 2 * triangles_.size(); }
  const Surface& surface(std::size_t patch) const { return surfaces_[surface_of_[patch / 2]]; }
  double patch_area(std::size_t patch) const { return triangles_[patch / 2].area; }
  /// Moved and scaled until the longest side is 1, as all positions are. Vertices that are at the
  /// same place in the description are so here.
  const render::TriangleMesh& mesh() const { return mesh_; }
  /// True if nothing stands between two vertices. Traces one shadow ray. A hit within 2^-12 of the
  /// way to the second is that point itself.
  bool sees(const Vertex& from, const Vertex& to, Cost& cost) const {
    ++cost.shadow_rays;
    constexpr double far = 1 - 0x1p-12;
    return !scene_.occluded(render::Ray{from.position, to.position - from.position, 0, far});
  }

  Vertex camera(Cost& cost) const {
    ++cost.camera_rays;
    return arrive(camera_.position, camera_.direction);
  }
  /// `Random` gives uniform numbers: a stream, or the coordinates of a Markov chain.
  template <class Random>
  Vertex reflected(const Vertex& from, Random& random, Cost& cost) const {
    ++cost.closest_hit_rays;
    const double u = random.uniform();
    const double v = random.uniform();
    return reflected(from, u, v);
  }
  /// The same for a pair of numbers in the unit square.
  Vertex reflected(const Vertex& from, double u, double v) const {
    return arrive(from.position,
                  render::Frame::about(from.normal).to_world(render::cosine_hemisphere(u, v)));
  }
  Vertex mirrored(const Vertex& from, Cost& cost) const {
    ++cost.closest_hit_rays;
    return arrive(from.position, from.arriving - 2 * dot(from.arriving, from.normal) * from.normal);
  }
  /// The direct light that v reflects; in closed form in a furnace only.
  Rgb direct_light(const Vertex& v, Direct direct, Stream& random, Cost& cost) const {
    if (direct == Direct::sampled) return sampled_light(v, random, cost);
    return v.surface->diffuse * v.surface->emission;
  }

  /// A vertex at a point of a patch, uniform for (u, v) uniform in the unit square.
  Vertex on_patch(std::size_t patch, double u, double v) const;

 private:
  struct Triangle {
    render::Vector3 corner;
    render::Vector3 first_edge;
    render::Vector3 second_edge;
    render::Vector3 normal;  ///< unit
    double shift = 0;        ///< fraction of the way to the centre of the inscribed circle
    render::Vector3 inside;  ///< shift x that centre
    double height = 0;       ///< shift / 4 x the circle's radius
    double area = 0;
  };

  /// Albedo / pi x emission x cosines / squared distance x area, of a point of an emitter. The
  /// point is drawn in proportion to mean emission x area. The value is 0 if something stands
  /// between. Traces one shadow ray if a cosine is positive.
  Rgb sampled_light(const Vertex& v, Stream& random, Cost& cost) const;

  static Triangle triangle(const std::array<render::Vector3, 3>& corners);

  // The point of a triangle that a path goes on from, on the side that `arriving` comes from.
  Vertex vertex(std::uint32_t triangle, const render::Vector3& point,
                const render::Vector3& arriving) const {
    const Triangle& t = triangles_[triangle];
    const bool back = dot(arriving, t.normal) >= 0;
    const render::Vector3 normal = back ? -t.normal : t.normal;
    // Off the plane by rounding only: the projection puts it there.
    const render::Vector3 flat = point - dot(point - t.corner, t.normal) * t.normal;
    return {(1 - t.shift) * flat + t.inside + t.height * normal, normal, arriving,
            &surfaces_[surface_of_[triangle]], 2 * triangle + back};
  }
  Vertex arrive(const render::Vector3& origin, const render::Vector3& direction) const {
    const render::Hit hit = scene_.closest_hit(render::Ray{origin, direction});
    if (hit.shape == render::Hit::none) return {};
    return vertex(hit.primitive, origin + hit.t * direction, direction);
  }

  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> surface_of_;
  render::TriangleMesh mesh_;
  std::vector<Triangle> triangles_;
  render::ShareTable light_;
  Camera camera_;
  ZonedScene furnace_;
  render::Scene scene_;
};

/// Radiance that arrives on average, and the part of it that has been reflected at least once.
struct Incoming {
  Rgb all;
  Rgb reflected;
};

/// One estimate for the whole scene: what is emitted, times the geometric series of the mean
/// albedo.
Incoming global_incoming(const Rgb& mean_emission, const Rgb& mean_albedo);
/// The same with means over the area of a mesh, both sides alike.
Incoming global_incoming(const MeshWorld& world);

/// One estimate for each patch. `rays` rays from each, at fixed points along fixed directions, say
/// which patches it sees. Light is then passed around until it no longer changes. Adds the rays to
/// the cost.
std::vector<Incoming> local_incoming(const MeshWorld& world, std::size_t rays, Cost& cost);

}  // namespace assay::paths
