#pragma once

// Scenes of a dozen quads and spheres, each with a material, and the lights among them.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "path_tracing/scattering.h"

namespace assay::path_tracing {

struct Ray {
  Vector3 origin;
  Vector3 direction;
};

/// A parallelogram. Its front, where its normal u x v points, emits.
class Quad {
 public:
  Quad(const Vector3& corner, const Vector3& u, const Vector3& v);

  /// The distance along the ray to a hit in (from, to), or `to`.
  double hit(const Ray& ray, double from, double to) const;
  const Vector3& normal_at(const Vector3&) const { return normal_; }
  /// A direction to a point uniform on the parallelogram.
  Vector3 direction_from(const Vector3& point, Stream& random) const;
  /// Its density per solid angle, if the ray hits at this distance.
  double density(const Ray& ray, double distance) const;

 private:
  Vector3 corner_, u_, v_, normal_;
  Vector3 along_u_, along_v_;  // the rows of the inverse of (u, v): coordinates by dot products
  double area_;
};

/// Its outside emits.
class Sphere {
 public:
  Sphere(const Vector3& centre, double radius) : centre_(centre), radius_(radius) {}

  double hit(const Ray& ray, double from, double to) const;
  Vector3 normal_at(const Vector3& point) const { return (point - centre_) / radius_; }
  /// A direction uniform in the cone that the sphere fills, seen from outside.
  Vector3 direction_from(const Vector3& point, Stream& random) const;
  double density(const Ray& ray, double distance) const;

 private:
  /// 1 - cos of the half angle of that cone, without cancellation.
  double cone(const Vector3& to_centre) const;

  Vector3 centre_;
  double radius_;
};

struct Thing {
  std::variant<Quad, Sphere> shape;
  Material material;
  Spectrum emission = {};

  bool emits() const { return !(emission == Spectrum{}); }
};

struct Hit {
  const Thing* thing = nullptr;  ///< none: the ray leaves the scene, and sees black
  double distance = 0;
};

struct Camera {
  Vector3 position;
  Vector3 target;
  double height = 1;  ///< of the film, one unit of length before the camera
};

/// `depth` is the largest number of scatterings of a path from the camera to a light.
class Scene {
 public:
  Scene(std::vector<Thing> things, Camera camera, int depth);

  /// The first thing hit at a distance of more than `from`.
  Hit trace(const Ray& ray, double from) const;
  /// The camera's ray through a point of the film; both coordinates are in [0, 1], from the top
  /// left, and `aspect` is width / height.
  Ray camera_ray(double x, double y, double aspect) const;
  const std::vector<const Thing*>& lights() const { return lights_; }
  int depth() const { return depth_; }

 private:
  std::vector<Thing> things_;
  std::vector<const Thing*> lights_;
  Camera camera_;
  Vector3 forward_, right_, down_;
  int depth_;
};

/// mild: a closed diffuse room with two boxes and a large light. glass: the room with a sphere of
/// glass, one of mirror and a small light. veach: four glossy plates and four spheres of light.
std::shared_ptr<const Scene> named_scene(const std::string& name);

}  // namespace assay::path_tracing
