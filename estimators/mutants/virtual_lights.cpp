// Mutants of virtual lights: the sound parts with one replaced.

#include <algorithm>
#include <utility>

#include "estimators/mutant.h"
#include "virtual_lights/lights.h"

namespace assay::plugins {

namespace {

using namespace virtual_lights;

// Replacements for parts of the kernels.

struct TargetIntegralOne : Weighted {
  Rgb result(const Sums& sums, double) const {
    return sums.target > 0 ? 1 / sums.target * sums.full : Rgb{};
  }
};

struct DensityOfDirection : Weighted {
  double target(const LightPath& path, double geometry, bool seen) const {
    return seen ? geometry / path.from_cosine() : 0;
  }
};

struct TargetUnhidden : Weighted {
  double target(const LightPath& path, double geometry, bool) const {
    return Weighted::target(path, geometry, true);
  }
};

// Sums of the ratios and of their number.
struct MeanOfWeights : Weighted {
  Rgb full(const LightPath& path, double geometry) const {
    return 1 / Weighted::target(path, geometry, true) * Weighted::full(path, geometry);
  }
  double target(const LightPath&, double, bool seen) const { return seen ? 1 : 0; }
};

struct PowerNotDivided : Classic {
  Rgb result(const Sums& sums, double) const { return sums.full; }
};

struct ClampedDistance : Classic {
  double least = 0;  ///< distance, in units of the scene's longest side

  Rgb full(const LightPath& path, double geometry) const {
    const double square = squared_length(path.at.position - room->receiver().position);
    const double clamped = std::max(square, least * least);
    return Classic::full(path, geometry * square / clamped);
  }
};

template <class Broken>
std::shared_ptr<const Setup> weighted(Parameters& parameters) {
  const Scene scene = read_room(parameters);
  return setup(scene, weighted_recipe(Broken{read_weighted(parameters, scene.room)}));
}

std::shared_ptr<const Setup> other_paths(Parameters& parameters) {
  const Scene scene = read_room(parameters);
  const Weighted sound = read_weighted(parameters, scene.room);
  Recipe broken = weighted_recipe(sound);
  broken.sums = [sound](Stream& random, std::uint64_t primaries, Cost& cost) {
    Stream elsewhere = random.substream(1);
    Sums sums = shoot_all(sound, primaries, random, cost);
    sums.target = shoot_all(sound, primaries, elsewhere, cost).target;
    return sums;
  };
  return setup(scene, std::move(broken));
}

}  // namespace

std::vector<Entry> mutants_virtual_lights() {
  return {
      mutant({"target_integral_one", "virtual_lights/weighted",
              "takes the target's integral for 1 although not all of it can be shot at: 1 / G - 1 "
              "too much, +20 % in a cube that emits evenly, +32 % in the middle of the floor where "
              "the ceiling alone emits. It does not fall with M. `target_integral` is read and of "
              "no account."},
             weighted<TargetIntegralOne>),
      mutant({"density_of_direction", "virtual_lights/weighted",
              "divides the target, a density by area, by the density of the direction that the "
              "light was shot along: inconsistent, the limit depends on the units of length; -13 % "
              "in the middle of the floor of a unit cube that emits evenly."},
             weighted<DensityOfDirection>),
      mutant({"target_unhidden", "virtual_lights/weighted",
              "leaves the visibility between receiver and virtual light out of the target: too "
              "dark where something hides a part of what would be seen (by their form factors, "
              "-3.6 % in suites/data/room.obj); nothing in convex rooms."},
             weighted<TargetUnhidden>),
      mutant({"mean_of_weights", "virtual_lights/weighted",
              "averages the ratios of integrand and target in place of dividing their sums: "
              "inconsistent; by the marginal density +47 % in the middle of the floor of a cube "
              "whose ceiling alone emits."},
             weighted<MeanOfWeights>),
      mutant({"target_of_other_paths", "virtual_lights/weighted",
              "sums the target over other paths than the integrand: consistent, but the spikes of "
              "the two no longer cancel."},
             other_paths),
      mutant({"power_not_divided", "virtual_lights/classic",
              "gives each of M virtual lights the power of all: M times too much."},
             [](Parameters& parameters) {
               const Scene scene = read_room(parameters);
               return setup(scene, recipe(PowerNotDivided{{scene.room}}));
             }),
      mutant({"clamped_distance",
              "virtual_lights/classic",
              "takes no distance for less than `least_distance`: the spikes are gone, and so is "
              "the light that they stand for, more of it the nearer the receiver is to a corner.",
              {number_parameter("least_distance", "in units of the scene's longest side", "0.1",
                                {0})}},
             [](Parameters& parameters) {
               const Scene scene = read_room(parameters);
               return setup(scene, recipe(ClampedDistance{{scene.room},
                                                          parameters.number("least_distance")}));
             })};
}

}  // namespace assay::plugins
