#include "paths/terminal.h"

#include <cmath>

namespace assay::paths {

namespace {

// Additive recurrences with the powers of 1/g, g^5 = g + 1. They are even in four dimensions for
// any number of points (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
double recurrence(std::size_t index, int dimension) {
  constexpr double g = 1.1673039782614187;
  const double x = 0.5 + static_cast<double>(index + 1) * std::pow(g, -dimension);
  return x - std::floor(x);
}

template <class Property>
Spectrum area_mean(const MeshWorld& world, const Property& property) {
  Spectrum total;
  double area = 0;
  for (std::size_t i = 0; i < world.patches(); ++i) {
    area += world.patch_area(i);
    total += world.patch_area(i) * property(world.surface(i));
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

Incoming global_incoming(const Spectrum& mean_emission, const Spectrum& mean_albedo) {
  const Spectrum all = mean_emission / (Spectrum::grey(1) - mean_albedo);
  return {all, mean_albedo * all};
}

Spectrum mean_emission(const MeshWorld& world) {
  return area_mean(world, [](const Surface& s) { return s.emission; });
}

Spectrum mean_albedo(const MeshWorld& world) {
  return area_mean(world, [](const Surface& s) { return s.albedo(); });
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
        const Spectrum reflected = world.surface(j).albedo() * incoming[j].all;
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
