#include "path_tracing/scene.h"

#include <numbers>
#include <utility>

namespace assay::path_tracing {

namespace {

using render::cross;
using render::dot;
using render::normalised;
using std::numbers::pi;

}  // namespace

Quad::Quad(const Vector3& corner, const Vector3& u, const Vector3& v)
    : corner_(corner), u_(u), v_(v) {
  const Vector3 across = cross(u, v);
  area_ = render::length(across);
  normal_ = across / area_;
  along_u_ = cross(v, normal_) / area_;
  along_v_ = cross(normal_, u) / area_;
}

double Quad::hit(const Ray& ray, double from, double to) const {
  const double distance = dot(corner_ - ray.origin, normal_) / dot(ray.direction, normal_);
  if (!(distance > from && distance < to)) return to;
  const Vector3 point = ray.origin + distance * ray.direction - corner_;
  const double s = dot(point, along_u_);
  const double t = dot(point, along_v_);
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? distance : to;
}

Vector3 Quad::direction_from(const Vector3& point, Stream& random) const {
  const double s = random.uniform();
  const double t = random.uniform();
  return normalised(corner_ + s * u_ + t * v_ - point);
}

double Quad::density(const Ray& ray, double distance) const {
  return distance * distance / (area_ * std::abs(dot(ray.direction, normal_)));
}

double Sphere::hit(const Ray& ray, double from, double to) const {
  const Vector3 to_centre = centre_ - ray.origin;
  const double middle = dot(to_centre, ray.direction);
  const Vector3 across = to_centre - middle * ray.direction;
  const double squared = radius_ * radius_ - render::squared_length(across);
  if (squared < 0) return to;
  const double half = std::sqrt(squared);
  const double near = middle - half;
  const double distance = near > from ? near : middle + half;
  return distance > from && distance < to ? distance : to;
}

double Sphere::cone(const Vector3& to_centre) const {
  const double squared_sine = radius_ * radius_ / render::squared_length(to_centre);
  return squared_sine / (1 + std::sqrt(std::max(1 - squared_sine, 0.0)));
}

Vector3 Sphere::direction_from(const Vector3& point, Stream& random) const {
  const Vector3 to_centre = centre_ - point;
  const double height = 1 - random.uniform() * cone(to_centre);
  return render::Frame::about(normalised(to_centre))
      .to_world(render::direction_at(height, random.uniform()));
}

double Sphere::density(const Ray& ray, double) const {
  return 1 / (2 * pi * cone(centre_ - ray.origin));
}

Scene::Scene(std::vector<Thing> things, Camera camera, int depth)
    : things_(std::move(things)), camera_(camera), depth_(depth) {
  for (const Thing& thing : things_) {
    if (thing.emits()) lights_.push_back(&thing);
  }
  forward_ = normalised(camera_.target - camera_.position);
  right_ = normalised(cross(forward_, {0, 1, 0}));
  down_ = cross(forward_, right_);
}

Hit Scene::trace(const Ray& ray, double from) const {
  Hit hit{.distance = std::numeric_limits<double>::infinity()};
  for (const Thing& thing : things_) {
    const double distance = std::visit(
        [&](const auto& shape) { return shape.hit(ray, from, hit.distance); }, thing.shape);
    if (distance < hit.distance) hit = {&thing, distance};
  }
  return hit;
}

Ray Scene::camera_ray(double x, double y, double aspect) const {
  const Vector3 direction =
      forward_ + (x - 0.5) * aspect * camera_.height * right_ + (y - 0.5) * camera_.height * down_;
  return {camera_.position, normalised(direction)};
}

}  // namespace assay::path_tracing
