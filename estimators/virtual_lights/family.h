#pragma once

// The common parts of virtual lights: parameters, channels, set-up.

#include <functional>
#include <memory>
#include <vector>

#include "virtual_lights/lights.h"

namespace assay::virtual_lights {

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

/// `scene` and `shininess`.
std::vector<ParameterInformation> room_parameters();
std::vector<ParameterInformation> weighted_parameters();

/// Writes one observation of `primaries` light paths.
using Observe = std::function<Sums(Stream&, std::uint64_t primaries, Cost&)>;
using Result = std::function<Spectrum(const Sums&, double primaries)>;

/// The way an observation is made. It may have the diagnostic channel `target`, the mean of g / p,
/// with its mean G if that is known.
struct Recipe {
  Observe sums;
  Result result;
  bool has_target = false;
  Known target = {};
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
  made.has_target = true;
  made.target = target_integral(*kernel.room, kernel.weighting);
  return made;
}

}  // namespace assay::virtual_lights
