#pragma once

// Scenes whose pictures are hard for tests: spheres and parallelograms of ideal materials.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimators/render/rgb.h"
#include "estimators/render/vector.h"

namespace assay::path_tracing {

using render::Rgb;
using render::Vector3;

/// Light ends at an emitter, which reflects nothing.
enum class Surface { diffuse, glossy, mirror, glass, emitter };

struct Material {
  Surface surface = Surface::diffuse;
  Rgb colour;             ///< albedo, or emitted radiance
  double exponent = 0;    ///< of a glossy lobe cos^n about the mirrored direction
  double refraction = 1;  ///< index of glass
};

struct Ray {
  Vector3 origin;
  Vector3 direction;  ///< of length 1
};

struct Hit {
  double distance = 0;
  Vector3 point;
  Vector3 normal;  ///< outwards of a sphere; along `normal` of a parallelogram
  const Material* material = nullptr;
  std::size_t shape = 0;
};

/// A sphere, or the parallelogram corner + s first + t second with s, t in [0, 1].
struct Shape {
  enum class Kind { sphere, parallelogram };
  Kind kind = Kind::sphere;
  Vector3 corner;  ///< or the centre
  Vector3 first;
  Vector3 second;
  double radius = 0;
  Vector3 normal;
  Material material;
};
Shape sphere(const Vector3& centre, double radius, const Material& material);
/// The normal is that of first x second.
Shape parallelogram(const Vector3& corner, const Vector3& first, const Vector3& second,
                    const Material& material);

/// A point on an emitter as seen from elsewhere.
struct LightPoint {
  Vector3 direction;
  double distance = 0;
  double density = 0;  ///< per steradian
  Rgb radiance;
};

class Scene {
 public:
  struct Camera {
    Vector3 eye;
    Vector3 corner;  ///< upper left of the image plane, seen from the eye
    Vector3 right;   ///< the whole width
    Vector3 down;    ///< the whole height
  };

  Scene(std::vector<Shape> shapes, Camera camera, std::size_t bounces);

  const Camera& camera() const { return camera_; }
  /// The most bounces of a path, beside those off mirrors and through glass.
  std::size_t bounces() const { return bounces_; }

  std::optional<Hit> closest(const Ray& ray) const;
  /// True if something is hit nearer than that.
  bool occluded(const Ray& ray, double nearer_than, double offset) const;

  /// A point of an emitter, all equally probable: spheres by the cone that they fill,
  /// parallelograms by area. A density of 0 where the emitter's back is seen.
  LightPoint sample_light(const Vector3& from, double choice, double u, double v) const;
  /// The density of sample_light for a ray from there that hit an emitter.
  double light_density(const Vector3& from, const Hit& hit, const Vector3& direction) const;

  /// Distance by which a ray's start is kept off its surface.
  static constexpr double offset = 1e-6;

 private:
  std::vector<Shape> shapes_;
  std::vector<std::size_t> lights_;
  Camera camera_;
  std::size_t bounces_;
};

/// Scene "box" has diffuse walls under a wide light. Scene "glass" has a glass sphere and a mirror
/// under a small light. Scene "plates" has four glossy plates under four lights, after Veach (1997,
/// figure 9.2).
std::shared_ptr<const Scene> scene_of(const std::string& name);

}  // namespace assay::path_tracing
