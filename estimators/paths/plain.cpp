// The trusted reference shares the scene with the other estimators and nothing of their roulette,
// direct light or splitting.

#include "paths/family.h"
#include "paths/path.h"

namespace assay::plugins {

namespace {

using namespace paths;

ParameterInformation survival_parameter() {
  return number_parameter("survival",
                          "q, the probability to go on at any vertex; the variance is finite where "
                          "it exceeds the square of every albedo",
                          "0.8", {0, 1, true, true});
}

Knowledge known(const Scene& scene, double survival) {
  std::optional<Steps> steps = Steps{.survival = [survival](const Surface&) { return survival; }};
  if (scene.law && scene.law->has_mirrors()) steps.reset();
  Knowledge all = knowledge(scene, steps);
  all.low = 0;
  return all;
}

std::shared_ptr<const Setup> plain(Parameters& parameters) {
  const Scene scene = paths::read_scene(parameters);
  const double q = parameters.number("survival");
  return setup_in_world(scene, known(scene, q),
                        [q](const auto& world, auto& random, Tally& tally, Cost& cost) {
                          paths::walk(world, world.camera(cost), q, random, tally, cost);
                        },
                        {direction_sampler()});
}

std::shared_ptr<const Setup> ray_free(Parameters& parameters) {
  const SceneDescription description =
      paths::read_scene(parameters.structure("scene"), parameters.folder());
  const auto* const sphere = std::get_if<SphereScene>(&description.form);
  parameters.require(sphere, "scene", "only a sphere can be walked without rays: give it zones");
  const Scene scene = paths::read_scene(parameters);
  const double q = parameters.number("survival");
  const auto world = std::make_shared<const RayFreeWorld>(*sphere, description.camera);
  return setup(scene, known(scene, q), [world, q](Stream& random, Tally& tally, Cost& cost) {
    paths::walk(*world, world->camera(cost), q, random, tally, cost);
  });
}

}  // namespace

std::vector<Entry> paths_plain() {
  return {
      {{.name = "paths/plain",
        .summary = "Radiance by the plainest path tracer: the trusted reference.",
        .description =
            "A path goes on with probability q at every vertex and adds throughput x emission "
            "where it arrives; the throughput is multiplied by albedo / q. A mirror's share is "
            "chosen with probability 1/2. Unbiased (Kajiya 1986). In spheres the mean is Le + a "
            "(mean Le) / (1 - mean a), in furnaces Le / (1 - a); there the variance is known, too: "
            "a^2 L^2 (1 - q) / (q - a^2) in a furnace. Diagnostic channels: `vertices`, and "
            "`bounce_1` to `bounce_6`, the vertices at each bounce. Cost: a camera ray and a "
            "closest-hit ray a bounce. Sampler: direction (of diffuse reflection).",
        .parameters = {scene_parameter("furnace"), survival_parameter()}},
       plain},
      {{.name = "paths/ray_free",
        .summary = "The integrating sphere without rays: vertices uniform on the sphere.",
        .description = "paths/plain in a sphere with zones, the next vertex drawn uniformly on the "
                       "sphere instead of traced to: a diffuse reflection inside a sphere has "
                       "density cos / pi, and cos' / r^2 = 1 / (2 R) for any two points. The same "
                       "law as paths/plain without any geometry. Traces no rays.",
        .parameters = {scene_parameter("sphere"), survival_parameter()}},
       ray_free}};
}

}  // namespace assay::plugins
