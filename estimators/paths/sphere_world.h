#pragma once

// Paths inside a sphere with zones, by rays and without.

#include "estimators/cost.h"
#include "estimators/stream.h"
#include "paths/scene_description.h"
#include "paths/zone_law.h"
#include "render/frame.h"
#include "render/hemisphere.h"
#include "render/sphere_scene.h"

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
  const Camera& camera() const { return camera_; }
  const render::Vector3& seen() const { return seen_; }

 private:
  std::vector<double> tops_;
  ZonedScene law_;
  Camera camera_;
  render::Vector3 seen_;
};

inline render::Vector3 uniform_on_sphere(Stream& random) {
  const double z = 2 * random.uniform() - 1;
  return render::direction_at(z, random.uniform());
}

/// By Embree's rays: diffuse directions have the density cos / pi, whatever they hit.
class SphereWorld {
 public:
  SphereWorld(const SphereScene& scene, const Camera& camera)
      : zones_(scene, camera), mean_emission_(zones_.law().mean_emission()) {}

  const Zones& zones() const { return zones_; }

  Vertex camera(Cost& cost) const {
    ++cost.camera_rays;
    const Camera& camera = zones_.camera();
    return zones_.vertex(scene_.exit(camera.position, camera.direction, false));
  }
  /// `Random` gives uniform numbers: a stream, or the coordinates of a Markov chain.
  template <class Random>
  Vertex reflected(const Vertex& from, Random& random, Cost& cost) const {
    ++cost.closest_hit_rays;
    const double u = random.uniform();
    const double v = random.uniform();
    const render::Vector3 direction =
        render::Frame::about(from.normal).to_world(render::cosine_hemisphere(u, v));
    return zones_.vertex(scene_.exit(from.position, direction, true));
  }
  /// Zones have no mirrors.
  Vertex mirrored(const Vertex&, Cost&) const { return {}; }

  /// The direct light that v reflects: the irradiance over pi is the mean emission everywhere.
  Spectrum direct_light(const Vertex& v, Direct direct, Stream& random, Cost& cost) const {
    if (direct == Direct::sampled) return sampled_light(v, random, cost);
    return v.surface->diffuse * mean_emission_;
  }

 private:
  /// Traces one shadow ray to a point uniform on the sphere. The product of the cosines of two
  /// points over their squared distance is 1/4. With the area 4 pi and albedo / pi this leaves
  /// albedo x emission.
  Spectrum sampled_light(const Vertex& v, Stream& random, Cost& cost) const {
    const Vertex light = zones_.vertex(uniform_on_sphere(random));
    if (light.surface->emission == Spectrum{}) return {};
    ++cost.shadow_rays;
    if (scene_.occluded(v.position, light.position)) return {};
    return v.surface->diffuse * light.surface->emission;
  }

  Zones zones_;
  Spectrum mean_emission_;
  render::SphereScene scene_;
};

/// Without rays: the next vertex is a uniform point, as the hit of a cosine-distributed ray is.
class RayFreeWorld {
 public:
  RayFreeWorld(const SphereScene& scene, const Camera& camera) : zones_(scene, camera) {}

  const Zones& zones() const { return zones_; }
  Vertex camera(Cost&) const { return zones_.vertex(zones_.seen()); }
  Vertex reflected(const Vertex&, Stream& random, Cost&) const {
    return zones_.vertex({0, 0, 2 * random.uniform() - 1});
  }
  Vertex mirrored(const Vertex&, Cost&) const { return {}; }

 private:
  Zones zones_;
};

}  // namespace assay::paths
