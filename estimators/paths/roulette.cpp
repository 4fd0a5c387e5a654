// Paths that end by Russian roulette, classical and with terminal values (Szecsi, Szirmay-Kalos and
// Kelemen 2003).
//
// At a vertex of throughput T and albedo a path goes on with probability s: T becomes T a / s. With
// a terminal value e a path that ends adds T e. One that goes on adds T e (s - 1) / s. The two
// cancel on average for every e. The classical roulette with s = a has the variance Le^2 a / (1 -
// a)^2 in a furnace. A terminal value e = kappa a L multiplies it by (1 - kappa)^2.

#include "paths/family.h"
#include "paths/roulette_setup.h"

namespace assay::plugins {

namespace {

using namespace paths;

template <class Plan>
std::shared_ptr<const Setup> prepared(Parameters& parameters, const Plan& plan_of) {
  const Scene scene = paths::read_scene(parameters);
  const RoulettePlan plan = plan_of(parameters, scene);
  Knowledge known = knowledge(scene, exact_steps(scene, plan));
  if (plan.terminal.empty()) known.low = 0;
  std::vector<NamedSampler> samplers = samplers_of(scene, plan, known);
  return with_world(scene, [&](const auto& world) {
    const Roulette roulette = plan.roulette(scene);
    return setup(
        scene, known,
        [world, roulette, direct = plan.direct](Stream& random, Tally& tally, Cost& cost) {
          trace(*world, roulette, direct, random, tally, cost);
        },
        std::move(samplers), plan.cost);
  });
}

}  // namespace

std::vector<Entry> paths_roulette() {
  return {
      {{.name = "paths/roulette",
        .summary = "Radiance by paths that end by classical Russian roulette.",
        .description =
            "Goes on with probability s and multiplies the throughput T by a / s. s by `rule`, a "
            "the albedo: max_albedo, mean_albedo, luminance (of a), throughput (sum T a / sum "
            "T), radiance (sum T a L / sum T L, L the scene's mean radiance for each colour); "
            "equal in grey scenes. A mirror is chosen in proportion to the rule's value for it. "
            "Unbiased for every rule. `direct` says how emitted light is learnt of. Mean exact in "
            "spheres and furnaces, variance there too where s depends on the surface alone: in a "
            "grey furnace Le^2 a / (1 - a)^2. Diagnostic channels: vertices, bounce_1 to "
            "bounce_6. Cost: a camera ray, a closest-hit ray a bounce, a shadow ray where one is "
            "traced. Samplers: direction; in spheres hit (where a reflected ray arrives, uniform "
            "on the sphere); length (the number of bounces, in a furnace where the law is known).",
        .parameters = {scene_parameter("furnace"), rule_parameter(), direct_parameter()}},
       [](Parameters& p) { return prepared(p, read_classical); }},
      {{.name = "paths/improved_roulette",
        .summary = "Radiance by paths that end by Russian roulette with terminal values.",
        .description =
            "A path that ends adds T e, one that goes on T e (s - 1) / s: unbiased for every e "
            "(Szecsi, Szirmay-Kalos and Kelemen 2003). e = scale x albedo x an estimate of the "
            "radiance that arrives: `global`, mean Le / (1 - mean albedo), or `local`, for each "
            "side of each triangle from 256 fixed rays and passing the light around (its rays are "
            "cost of the set-up). Where direct light is learnt of separately its part is left out "
            "of e. In a furnace the variance is (1 - scale)^2 times that of paths/roulette; in a "
            "sphere the global estimate is the local one. Everything else as paths/roulette.",
        .parameters = improved_parameters()},
       [](Parameters& p) { return prepared(p, read_improved); }}};
}

}  // namespace assay::plugins
