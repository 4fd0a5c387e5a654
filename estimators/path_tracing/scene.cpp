#include "path_tracing/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/vector.h"

namespace assay::path_tracing {
namespace {

using std::numbers::pi;
constexpr double none = std::numeric_limits<double>::infinity();

double distance_to(const Shape& shape, const Ray& ray, double least) {
  if (shape.kind == Shape::Kind::sphere) {
    const Vector3 to = shape.corner - ray.origin;
    const double along = dot(to, ray.direction);
    const Vector3 beside = to - along * ray.direction;
    const double under_root = shape.radius * shape.radius - squared_length(beside);
    if (!(under_root > 0)) return none;
    const double half = std::sqrt(under_root);
    if (along - half > least) return along - half;
    return along + half > least ? along + half : none;
  }
  const double slope = dot(shape.normal, ray.direction);
  if (slope == 0) return none;
  const Vector3 to = shape.corner - ray.origin;
  const double distance = dot(shape.normal, to) / slope;
  if (!(distance > least)) return none;
  const Vector3 inside = distance * ray.direction - to;
  const Vector3 across = cross(shape.first, shape.second);
  const double area = dot(across, across);
  const double s = dot(cross(inside, shape.second), across) / area;
  const double t = dot(cross(shape.first, inside), across) / area;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? distance : none;
}

/// 1 - cos of the half angle of the cone that a sphere fills; 2 from inside.
double one_less_cosine(const Shape& sphere, const Vector3& from) {
  const double ratio = sphere.radius * sphere.radius / squared_length(sphere.corner - from);
  return ratio < 1 ? ratio / (1 + std::sqrt(1 - ratio)) : 2;
}

Material diffuse(const Rgb& albedo) { return {.surface = Surface::diffuse, .colour = albedo}; }
Material glossy(const Rgb& albedo, double exponent) {
  return {.surface = Surface::glossy, .colour = albedo, .exponent = exponent};
}
Material emitter(double radiance) {
  return {.surface = Surface::emitter, .colour = {radiance, radiance, radiance}};
}

/// The unit box, open towards the eye at z = 1, and its camera.
std::vector<Shape> box() {
  const Material white = diffuse({.72, .72, .70});
  return {parallelogram({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, white),
          parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, white),
          parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, white),
          parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, diffuse({.63, .06, .05})),
          parallelogram({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, diffuse({.14, .45, .09}))};
}
constexpr Scene::Camera box_camera{
    .eye = {.5, .5, 2.3}, .corner = {-.6, .45, -1.3}, .right = {1.2, 0, 0}, .down = {0, -.9, 0}};

Scene mild_box() {
  std::vector<Shape> shapes = box();
  shapes.push_back(parallelogram({.2, .999, .2}, {.6, 0, 0}, {0, 0, .6}, emitter(4)));
  shapes.push_back(sphere({.3, .25, .4}, .25, diffuse({.6, .6, .7})));
  shapes.push_back(sphere({.72, .18, .6}, .18, diffuse({.7, .65, .4})));
  return {std::move(shapes), box_camera, 4};
}

Scene glass_box() {
  std::vector<Shape> shapes = box();
  shapes.push_back(parallelogram({.44, .999, .44}, {.12, 0, 0}, {0, 0, .12}, emitter(90)));
  shapes.push_back(sphere({.68, .22, .6}, .22, {.surface = Surface::glass, .refraction = 1.5}));
  shapes.push_back(
      sphere({.28, .26, .35}, .26, {.surface = Surface::mirror, .colour = {.95, .95, .95}}));
  return {std::move(shapes), box_camera, 5};
}

Scene plates() {
  std::vector<Shape> shapes{
      parallelogram({-6, -1, -2}, {0, 0, 8}, {12, 0, 0}, diffuse({.4, .4, .4})),
      parallelogram({-6, -1, -2}, {12, 0, 0}, {0, 7, 0}, diffuse({.4, .4, .4}))};
  constexpr Vector3 eye{0, 1.6, 7};
  constexpr double light_height = 2.4;
  constexpr double light_depth = -.4;
  constexpr double exponents[] = {20, 200, 2000, 20000};
  for (int i = 0; i < 4; ++i) {
    // Each plate mirrors the lights to the eye.
    const Vector3 middle{0, -.8 + .35 * i, 1.6 - .75 * i};
    const Vector3 to_light = render::normalised(Vector3{0, light_height, light_depth} - middle);
    const Vector3 normal = render::normalised(render::normalised(eye - middle) + to_light);
    const Vector3 up = .6 * Vector3{0, normal.z, -normal.y};
    shapes.push_back(parallelogram(middle - .5 * up - Vector3{2.2, 0, 0}, {4.4, 0, 0}, up,
                                   glossy({.6, .6, .6}, exponents[i])));
  }
  constexpr double radii[] = {.03, .1, .3, .8};
  for (int i = 0; i < 4; ++i) {
    const double radius = radii[i];
    shapes.push_back(sphere({-2.7 + 1.8 * i, light_height, light_depth}, radius,
                            emitter(.35 / (radius * radius))));
  }
  return {std::move(shapes),
          {.eye = eye, .corner = {-.4, .22, -1}, .right = {.8, 0, 0}, .down = {0, -.6, 0}},
          2};
}

}  // namespace

Shape sphere(const Vector3& centre, double radius, const Material& material) {
  return {.kind = Shape::Kind::sphere, .corner = centre, .radius = radius, .material = material};
}

Shape parallelogram(const Vector3& corner, const Vector3& first, const Vector3& second,
                    const Material& material) {
  return {.kind = Shape::Kind::parallelogram,
          .corner = corner,
          .first = first,
          .second = second,
          .radius = 0,
          .normal = render::normalised(cross(first, second)),
          .material = material};
}

Scene::Scene(std::vector<Shape> shapes, Camera camera, std::size_t bounces)
    : shapes_(std::move(shapes)), camera_(camera), bounces_(bounces) {
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (shapes_[i].material.surface == Surface::emitter) lights_.push_back(i);
  }
}

std::optional<Hit> Scene::closest(const Ray& ray) const {
  double nearest = none;
  std::size_t found = 0;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const double distance = distance_to(shapes_[i], ray, offset);
    if (distance < nearest) nearest = distance, found = i;
  }
  if (nearest == none) return {};
  const Shape& shape = shapes_[found];
  const Vector3 point = ray.origin + nearest * ray.direction;
  const Vector3 normal =
      shape.kind == Shape::Kind::sphere ? (point - shape.corner) / shape.radius : shape.normal;
  return Hit{nearest, point, normal, &shape.material, found};
}

bool Scene::occluded(const Ray& ray, double nearer_than, double least) const {
  return std::ranges::any_of(shapes_, [&](const Shape& shape) {
    return distance_to(shape, ray, least) < nearer_than - least;
  });
}

LightPoint Scene::sample_light(const Vector3& from, double choice, double u, double v) const {
  const auto count = static_cast<double>(lights_.size());
  const Shape& light =
      shapes_[lights_[std::min(static_cast<std::size_t>(choice * count), lights_.size() - 1)]];
  LightPoint found{.radiance = light.material.colour};
  if (light.kind == Shape::Kind::sphere) {
    const double height = one_less_cosine(light, from);
    const double cosine = 1 - u * height;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    found.direction =
        render::Frame::about(render::normalised(light.corner - from))
            .to_world({sine * std::cos(2 * pi * v), sine * std::sin(2 * pi * v), cosine});
    found.distance = distance_to(light, {from, found.direction}, offset);
    // The rim of the cone can pass by the sphere for rounding.
    if (found.distance == none) return found;
    found.density = 1 / (2 * pi * height * count);
    return found;
  }
  const Vector3 to = light.corner + u * light.first + v * light.second - from;
  found.distance = render::length(to);
  found.direction = to / found.distance;
  const double cosine = -dot(light.normal, found.direction);
  if (!(cosine > 0)) return found;
  const double area = render::length(cross(light.first, light.second));
  found.density = found.distance * found.distance / (cosine * area * count);
  return found;
}

double Scene::light_density(const Vector3& from, const Hit& hit, const Vector3& direction) const {
  const auto count = static_cast<double>(lights_.size());
  const Shape& light = shapes_[hit.shape];
  if (light.kind == Shape::Kind::sphere) {
    return 1 / (2 * pi * one_less_cosine(light, from) * count);
  }
  const double area = render::length(cross(light.first, light.second));
  return hit.distance * hit.distance / (std::abs(dot(light.normal, direction)) * area * count);
}

std::shared_ptr<const Scene> scene_of(const std::string& name) {
  if (name == "glass") return std::make_shared<const Scene>(glass_box());
  return std::make_shared<const Scene>(name == "plates" ? plates() : mild_box());
}

}  // namespace assay::path_tracing
