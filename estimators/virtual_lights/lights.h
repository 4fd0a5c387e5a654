#pragma once

// Sums over light paths of the light that virtual lights bring to the receiver, and estimates from
// them. Parts that a mutant can replace are members of a template parameter.

#include <functional>
#include <memory>
#include <numbers>

#include "virtual_lights/room.h"

namespace assay::virtual_lights {

/// Sums over the light paths of an observation.
struct Sums {
  Rgb full;           ///< of f / p
  double target = 0;  ///< of g / p
};

/// The mean of f / p: classical virtual lights.
struct Classic {
  SharedRoom room;

  LightPath shoot(Stream& random, Cost& cost) const { return room->shoot(random, cost); }
  Rgb full(const LightPath& path, double geometry) const { return room->reflected(path, geometry); }
  double target(const LightPath&, double /*geometry*/, bool /*seen*/) const { return 0; }
  Rgb result(const Sums& sums, double count) const { return 1 / count * sums.full; }
};

/// Weighted importance sampling: G sum (f / p) / sum (g / p), g = geometry V / pi. 0 if no path has
/// been seen.
struct Weighted : Classic {
  Weighting weighting = Weighting::conditional;
  double target_integral = 1;  ///< G

  double density(const LightPath& path) const {
    if (weighting == Weighting::marginal) return room->marginal_density(path.at);
    return path.from_cosine() * path.at_cosine() / (std::numbers::pi * path.squared_distance());
  }
  double target(const LightPath& path, double geometry, bool seen) const {
    return seen ? geometry / (std::numbers::pi * density(path)) : 0;
  }
  Rgb result(const Sums& sums, double /*count*/) const {
    return sums.target > 0 ? target_integral / sums.target * sums.full : Rgb{};
  }
};

/// The sums of `count` light paths.
template <class Kernel>
Sums shoot_all(const Kernel& kernel, std::uint64_t count, Stream& random, Cost& cost) {
  Sums sums;
  for (std::uint64_t i = 0; i < count; ++i) {
    const LightPath path = kernel.shoot(random, cost);
    const double geometry = path.at.surface ? kernel.room->geometry(path.at) : 0;
    if (geometry == 0) continue;
    const bool seen = kernel.room->sees(path.at, cost);
    if (seen) sums.full += kernel.full(path, geometry);
    sums.target += kernel.target(path, geometry, seen);
  }
  cost.samples += count;
  return sums;
}

/// A room and how it is told.
struct Scene {
  SharedRoom room;
  bool grey = true;
};

/// Reads `scene` and `shininess`. InputError at the first for a sphere of zones, a mirror, or a
/// scene without light. The same for a camera that sees nothing or something black. InputError at
/// the second if a glossy receiver is not seen from straight above.
Scene read_room(Parameters&);

/// Reads `weighting` and `target_integral`. InputError at the first where the marginal density is
/// not known, at the second where `exact` is asked for and not known, saying why.
Weighted read_weighted(Parameters&, SharedRoom);

/// The way an observation is made. It may have the diagnostic channel `target`, the mean of g / p,
/// with its mean G if that is known.
struct Recipe {
  std::function<Sums(Stream&, std::uint64_t primaries, Cost&)> sums;
  std::function<Rgb(const Sums&, double primaries)> result;
  std::optional<Known> target = {};
};

std::shared_ptr<const Setup> setup(const Scene&, Recipe);

template <class Kernel>
Recipe recipe(const Kernel& kernel) {
  return {[kernel](Stream& random, std::uint64_t primaries, Cost& cost) {
            return shoot_all(kernel, primaries, random, cost);
          },
          [kernel](const Sums& sums, double primaries) { return kernel.result(sums, primaries); }};
}

/// The same of a weighted kernel, with its channel `target`.
template <class Kernel>
Recipe weighted_recipe(const Kernel& kernel) {
  Recipe made = recipe(kernel);
  made.target = target_integral(*kernel.room, kernel.weighting);
  return made;
}

}  // namespace assay::virtual_lights
