#include "paths/worlds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "estimators/core/mapped.h"

namespace assay::paths {

using render::TriangleMesh;
using render::Vector3;

namespace {

// Moves a scene to the origin and scales its longest side to 1, where single precision is finest.
// Radiance does not change.
Vector3 fitted(const render::Box& box, const Vector3& v) {
  return 1 / box.longest_side() * (v - box.centre());
}
TriangleMesh fitted(TriangleMesh mesh) {
  const render::Box box(mesh);
  for (Vector3& v : mesh.vertices) v = fitted(box, v);
  return mesh;
}

// Additive recurrences with the powers of 1/g, g^5 = g + 1. They are even in four dimensions for
// any number of points (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
double recurrence(std::size_t index, int dimension) {
  constexpr double g = 1.1673039782614187;
  const double x = 0.5 + static_cast<double>(index + 1) * std::pow(g, -dimension);
  return x - std::floor(x);
}

template <class Property>
Rgb area_mean(const MeshWorld& world, const Property& property) {
  Rgb total;
  double area = 0;
  for (std::size_t i = 0; i < world.patches(); ++i) {
    area += world.patch_area(i);
    total += world.patch_area(i) * std::invoke(property, world.surface(i));
  }
  return 1 / area * total;
}

// The patches that the rays of each patch arrive at; those that leave the scene bring nothing.
std::vector<std::vector<std::uint32_t>> seen_patches(const MeshWorld& world, std::size_t rays) {
  std::vector<std::vector<std::uint32_t>> seen(world.patches());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t k = 0; k < rays; ++k) {
      const Vertex from = world.on_patch(i, recurrence(k, 1), recurrence(k, 2));
      const Vertex to = world.reflected(from, recurrence(k, 3), recurrence(k, 4));
      if (to.surface) seen[i].push_back(to.patch);
    }
  }
  return seen;
}

}  // namespace

Zones::Zones(const SphereScene& scene, const Camera& camera)
    : seen_(exit_of_sphere(camera.position, camera.direction, false)) {
  double below = -1;
  for (const SphereScene::Zone& zone : scene.zones) {
    tops_.push_back(zone.top);
    // By Archimedes the area between two heights is in proportion to their difference.
    law_.zones.push_back({(zone.top - below) / 2, zone.surface});
    below = zone.top;
  }
  // Rounding may place a point at the pole a hair above 1.
  tops_.back() = 2;
  law_.seen = at(seen_.z);
}

MeshWorld::Triangle MeshWorld::triangle(const std::array<Vector3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector3 across = cross(b - a, c - a);
  const double at_a = length(c - b);
  const double at_b = length(a - c);
  const double at_c = length(b - a);
  const double around = at_a + at_b + at_c;
  const Vector3 centre = (at_a * a + at_b * b + at_c * c) / around;
  const double area = length(across) / 2;
  const double radius = 2 * area / around;
  const double shift = std::min(0.5, std::max(mesh_resolution, least_shift / radius));
  return {a, b - a, c - a, normalised(across), shift, shift * centre, shift / 4 * radius, area};
}

MeshWorld::MeshWorld(const MeshScene& scene, const Camera& camera)
    : surfaces_(scene.surfaces),
      surface_of_(scene.surface_of),
      mesh_(fitted(scene.mesh)),
      triangles_(mapped_indices(mesh_.triangles.size(),
                                [&](std::size_t i) { return triangle(mesh_.corners(i)); })),
      light_(mapped_indices(triangles_.size(),
                            [&](std::size_t i) {
                              return triangles_[i].area * mean(surfaces_[surface_of_[i]].emission);
                            })),
      camera_{fitted(render::Box(scene.mesh), camera.position), camera.direction},
      scene_({mesh_}) {
  if (scene.furnace) furnace_ = {{{1, surfaces_[0]}}, 0};
}

Vertex MeshWorld::on_patch(std::size_t patch, double u, double v) const {
  const Triangle& t = triangles_[patch / 2];
  const double root = std::sqrt(u);
  const Vector3 point = t.corner + root * (1 - v) * t.first_edge + root * v * t.second_edge;
  const Vector3 arriving = patch % 2 == 0 ? -t.normal : t.normal;
  return vertex(static_cast<std::uint32_t>(patch / 2), point, arriving);
}

Rgb MeshWorld::sampled_light(const Vertex& v, Stream& random, Cost& cost) const {
  const auto [triangle, x, y] = light_.choose(random);
  const Vertex light = on_patch(2 * std::size_t{triangle}, x, y);
  const Vector3 way = light.position - v.position;
  const double square = squared_length(way);
  const double leaving = dot(way, v.normal);
  const double cosines =
      leaving * std::abs(dot(way, triangles_[triangle].normal)) / (square * square);
  if (!(leaving > 0) || cosines == 0) return {};
  if (!sees(v, light, cost)) return {};
  const Rgb& emission = light.surface->emission;
  const double area_over_share = light_.total() / mean(emission);
  return cosines * area_over_share / std::numbers::pi * (v.surface->diffuse * emission);
}

Incoming global_incoming(const Rgb& mean_emission, const Rgb& mean_albedo) {
  const Rgb all = mean_emission / (Rgb::grey(1) - mean_albedo);
  return {all, mean_albedo * all};
}

Incoming global_incoming(const MeshWorld& world) {
  return global_incoming(area_mean(world, &Surface::emission), area_mean(world, &Surface::albedo));
}

std::vector<Incoming> local_incoming(const MeshWorld& world, std::size_t rays, Cost& cost) {
  const auto seen = seen_patches(world, rays);
  cost.closest_hit_rays += seen.size() * rays;
  std::vector<Incoming> incoming(seen.size());
  // A sweep leaves at most the largest albedo of the error. Below changes of a thousandth the rest
  // matters no more than the estimate's own roughness.
  for (double change = 1; change > 1e-3;) {
    change = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      Incoming next;
      for (const std::uint32_t j : seen[i]) {
        const Rgb reflected = world.surface(j).albedo() * incoming[j].all;
        next.reflected += reflected;
        next.all += world.surface(j).emission + reflected;
      }
      const double share = 1 / static_cast<double>(rays);
      next = {share * next.all, share * next.reflected};
      const double grown = largest(next.all) - largest(incoming[i].all);
      if (grown > change * largest(next.all)) change = grown / largest(next.all);
      incoming[i] = next;
    }
  }
  return incoming;
}

}  // namespace assay::paths
