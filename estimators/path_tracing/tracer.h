#pragma once

// One path from the camera, with light found by chance, by sampling, or by both.

#include "estimators/cost.h"
#include "path_tracing/scene.h"

namespace assay::path_tracing {

/// How a path finds light that its last surface scatters. Light that the camera, a mirror or glass
/// sees is always found by the path itself.
enum class Integrator {
  bsdf,   ///< the path hits a light
  light,  ///< a shadow ray to a light
  mis     ///< both, weighted by the balance heuristic (Veach and Guibas 1995)
};

/// The parts of a path tracer that a mutant replaces.
struct SoundRules {
  static constexpr double shadow_start = 1e-6;  ///< where a shadow ray begins
  static constexpr double (*reflectance)(double cosine, double ratio) = fresnel;

  /// The density per solid angle of a light, as it is divided by and as it enters weights.
  static double light_density(double density, bool /*first*/) { return density; }
  /// The weight of a light sample and of a light that the path hits.
  static double sampled_weight(double light, double bsdf) { return light / (light + bsdf); }
  static double hit_weight(double light, double bsdf) { return bsdf / (light + bsdf); }
  /// The factor of a path that roulette spares with this probability.
  static double compensation(double survival) { return 1 / survival; }
};

template <class Rules>
class Tracer {
 public:
  Tracer(std::shared_ptr<const Scene> scene, Integrator integrator)
      : scene_(std::move(scene)), integrator_(integrator) {}

  const Scene& scene() const { return *scene_; }

  /// An estimate of the radiance that arrives along a camera's ray.
  Spectrum radiance(Ray ray, Stream& random, Cost& cost) const {
    Spectrum sum;
    Spectrum throughput = Spectrum::grey(1);
    double density = 0;  // of the ray's direction; 0 for the camera, mirrors and glass
    ++cost.camera_rays;
    for (int scatterings = 0;; ++scatterings) {
      const Hit hit = scene_->trace(ray, start);
      if (!hit.thing) return sum;
      const Vector3 point = ray.origin + hit.distance * ray.direction;
      const Vector3 normal = std::visit(
          [&](const auto& shape) -> Vector3 { return shape.normal_at(point); }, hit.thing->shape);
      if (hit.thing->emits() && render::dot(normal, ray.direction) < 0) {
        sum += hit_weight(ray, hit, density) * throughput * hit.thing->emission;
      }
      if (scatterings == scene_->depth()) return sum;
      const Rough* const rough = std::get_if<Rough>(&hit.thing->material);
      // A rough surface has two sides alike; glass has an inside.
      const bool back = rough && render::dot(normal, ray.direction) > 0;
      const render::Frame frame = render::Frame::about(back ? -normal : normal);
      const Vector3 in = frame.to_local(-ray.direction);
      if (rough && integrator_ != Integrator::bsdf) {
        sum += throughput * sampled_light(point, frame, *rough, in, random, cost);
      }
      const Scattered next = scatter_by(hit.thing->material, in, random);
      if (!next.survives) return sum;
      throughput = throughput * next.weight;
      if (scatterings >= certain) {
        const double survival = std::min(0.95, paths::largest(throughput));
        if (random.uniform() >= survival) return sum;
        throughput = Rules::compensation(survival) * throughput;
      }
      ray = {point, frame.to_world(next.out)};
      density = next.density;
      ++cost.closest_hit_rays;
    }
  }

 private:
  static constexpr double start = 1e-6;  // no ray hits where it begins
  static constexpr int certain = 3;      // scatterings before roulette

  double light_density(const Ray& ray, const Hit& hit) const {
    const double density = std::visit(
        [&](const auto& shape) { return shape.density(ray, hit.distance); }, hit.thing->shape);
    const std::vector<const Thing*>& lights = scene_->lights();
    return Rules::light_density(density / static_cast<double>(lights.size()),
                                hit.thing == lights.front());
  }

  double hit_weight(const Ray& ray, const Hit& hit, double density) const {
    if (density == 0 || integrator_ == Integrator::bsdf) return 1;
    if (integrator_ == Integrator::light) return 0;
    return Rules::hit_weight(light_density(ray, hit), density);
  }

  Spectrum sampled_light(const Vector3& point, const render::Frame& frame, const Rough& rough,
                         const Vector3& in, Stream& random, Cost& cost) const {
    const std::vector<const Thing*>& lights = scene_->lights();
    const auto chosen =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(lights.size()));
    const Thing& light = *lights[chosen];
    const Ray ray{point,
                  std::visit([&](const auto& shape) { return shape.direction_from(point, random); },
                             light.shape)};
    const Vector3 out = frame.to_local(ray.direction);
    if (out.z <= 0) return {};
    ++cost.shadow_rays;
    const Hit hit = scene_->trace(ray, Rules::shadow_start);
    if (hit.thing != &light) return {};
    const Vector3 normal = std::visit(
        [&](const auto& shape) -> Vector3 {
          return shape.normal_at(point + hit.distance * ray.direction);
        },
        light.shape);
    if (render::dot(normal, ray.direction) >= 0) return {};
    const double density = light_density(ray, hit);
    const double weight = integrator_ == Integrator::light
                              ? 1
                              : Rules::sampled_weight(density, rough.density(in, out));
    return weight * out.z / density * rough.value(in, out) * light.emission;
  }

  static Scattered scatter_by(const Material& material, const Vector3& in, Stream& random) {
    if (const Rough* rough = std::get_if<Rough>(&material)) return rough->scatter(in, random);
    if (const Glass* glass = std::get_if<Glass>(&material)) {
      return scatter(*glass, in, Rules::reflectance, random);
    }
    if (const Mirror* mirror = std::get_if<Mirror>(&material)) {
      return {{-in.x, -in.y, in.z}, mirror->reflectance};
    }
    return {.survives = false};
  }

  std::shared_ptr<const Scene> scene_;
  Integrator integrator_;
};

}  // namespace assay::path_tracing
