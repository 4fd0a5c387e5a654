// Virtual lights by weighted importance sampling: I^ = G sum (f / p) / sum (g / p).
//
// The target g is the density by area with which the receiver's reflection would choose the virtual
// light. For a diffuse receiver it is cos cos' V / (pi r^2); a glossy one multiplies it by its
// lobe. It has the spikes of f, so that the ratio has none. The shooting density of y1, given y0 or
// marginal, is p. (Balazs, Szirmay-Kalos and Antal 2003, "Weighted importance sampling in shooting
// algorithms".)
//
// G is the integral of g over the points that are shot at. It is less than 1 if virtual lights
// cannot be everywhere, as on the lamp's own plane. If g/p has a variance, the bias to first order
// is (I Var(g/p) / G^2 - Cov(f/p, g/p) / G) / M.

#include "virtual_lights/family.h"

namespace assay::plugins {

namespace {

using namespace virtual_lights;

std::shared_ptr<const Setup> weighted(Parameters& parameters) {
  const Scene scene = read_room(parameters);
  return setup(scene, weighted_recipe(read_weighted(parameters, scene.room)));
}

}  // namespace

std::vector<Entry> virtual_lights_weighted() {
  return {
      {{.name = "virtual_lights/weighted",
        .summary = "Light after two reflections by virtual lights, weighted importance sampling.",
        .description =
            "The integral of virtual_lights/classic as G sum (f / p) / sum (g / p) over M light "
            "paths: f / p is its primary, g = cos cos' V / (pi r^2) the density with which the "
            "receiver would choose the virtual light y1 (times its lobe if it is glossy), p the "
            "density with which it was shot: "
            "conditional, cos0 cos1 / (pi r0^2) given the point y0 of what emits, or marginal, "
            "the irradiance of y1 over all power, by Lambert's formula. (Balazs, Szirmay-Kalos "
            "and Antal 2003.) G is the integral of g over what can be shot at: 5/6 in a cube "
            "that emits evenly, 1 less the form factor of the ceiling where that alone emits. "
            "Biased, and consistent only with the right G. The bias falls like 1/M where g / p "
            "has a variance; with the conditional density it has none, since E[(g/p)^2] grows "
            "without bound where y1 is near the edge of the wall of y0, and the bias falls more "
            "slowly. Where emission is even and the density marginal f / g is constant, and the "
            "estimate exact. Diagnostic channel: `target`, the mean of g / p, whose expectation "
            "is G. Rays as virtual_lights/classic.",
        .parameters = weighted_parameters(),
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       weighted}};
}

}  // namespace assay::plugins
