// Go with the winners: paths that split where a large error is anticipated and end elsewhere.

#include "paths/family.h"
#include "paths/path.h"

namespace assay::plugins {

namespace {

using namespace paths;

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const Scene scene = paths::read_scene(parameters);
  const Direct direct = read_direct(parameters, scene);
  const double splitting = parameters.number("splitting");
  std::optional<Steps> steps;
  if (scene.law && scene.grey) {
    steps = {.survival = [](const Surface& surface) { return mean(surface.albedo()); },
             .direct = direct,
             .splitting = splitting};
  }
  Knowledge known = knowledge(scene, steps);
  known.low = 0;
  return setup_in_world(scene, known,
                        [rule = Winners(splitting), direct](const auto& world, auto&... run) {
                          Tree(world, rule, direct).trace(run...);
                        },
                        {direction_sampler()});
}

}  // namespace

std::vector<Entry> paths_winners() {
  return {
      {{.name = "paths/winners",
        .summary = "Radiance by trees of paths with fractional numbers of children.",
        .description =
            "At a vertex of weight W (its mean over the colours) a diffuse albedo d has n = W d N "
            "children on average and a mirror of reflectance m n = W m: floor(n + u), each of "
            "weight W a / n. N is `splitting`, the ratio of the anticipated errors (Szirmay-Kalos, "
            "Antal and Sbert 2005). Unbiased; with N = 1 and one colour it is the classical "
            "roulette. Diffuse children weigh 1/N, so below them there is one child or none and "
            "trees are finite without a guard. Mean exact in spheres and furnaces, variance and "
            "number of children there too in grey scenes without mirrors. Diagnostic channels: "
            "vertices, bounce_1 to bounce_6. Cost: a camera ray, a closest-hit ray a child, a "
            "shadow ray where one is traced. Sampler: direction.",
        .parameters = {scene_parameter("sphere"), direct_parameter(),
                       number_parameter("splitting",
                                        "N, children of a diffuse vertex of weight and albedo 1",
                                        "4", {1, 1000})}},
       prepare}};
}

}  // namespace assay::plugins
