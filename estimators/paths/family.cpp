#include "paths/family.h"

#include <numbers>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay::paths {

namespace {

Scene scene_of(const SphereScene& form, const Camera& camera) {
  auto world = std::make_shared<const SphereWorld>(form, camera);
  const ZonedScene& law = world->zones().law();
  return {world, true, law, global_incoming(law.mean_emission(), law.mean_albedo())};
}

Scene scene_of(const MeshScene& form, const Camera& camera) {
  auto world = std::make_shared<const MeshWorld>(form, camera);
  // A furnace needs no sum over its triangles: the right terminal value would show the sum's
  // rounding.
  if (form.furnace) {
    const ZonedScene& law = world->furnace();
    return {world, true, law, global_incoming(law.mean_emission(), law.mean_albedo())};
  }
  return {world, true, {}, global_incoming(*world)};
}

std::vector<ZoneSteps> zone_steps(const Scene& scene, const Steps& steps, std::size_t colour) {
  const ZonedScene& law = *scene.law;
  const double light = law.mean_emission()[colour];
  double square = 0;
  for (const ZonedScene::Zone& z : law.zones) {
    square += z.fraction * z.surface.emission[colour] * z.surface.emission[colour];
  }
  return mapped(law.zones, [&](const ZonedScene::Zone& z) {
    ZoneSteps zone{.fraction = z.fraction,
                   .albedo = z.surface.albedo()[colour],
                   .survival = steps.survival(z.surface),
                   .terminal = steps.terminal(z.surface)[colour]};
    // The emission that arrives along the camera's ray is added to the mean elsewhere and has no
    // variance.
    zone.score = steps.direct == Direct::hit ? z.surface.emission[colour] : zone.albedo * light;
    if (steps.direct == Direct::sampled) {
      zone.score_variance = zone.albedo * zone.albedo * (square - light * light);
    }
    return zone;
  });
}

// True if the variance's recursion describes the path. Mirrors keep it only in grey furnaces whose
// light is found by hits. A furnace's shadow rays have no closed form.
bool has_variance(const Scene& scene, const Steps& steps) {
  const bool plain = scene.grey && steps.direct == Direct::hit && steps.splitting == 1;
  if (scene.law->has_mirrors() && !plain) return false;
  return steps.direct != Direct::sampled || std::holds_alternative<SharedSphere>(scene.world);
}

void add_steps(Knowledge& known, const Scene& scene, const Steps& steps) {
  if (!has_variance(scene, steps)) return;
  const ZonedScene& law = *scene.law;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto zones = zone_steps(scene, steps, c);
    const std::optional<double> variance = path_variance(zones, law.seen, steps.splitting);
    const double mean = *known.colours[c].mean;
    // A difference that is nothing but rounding is not stated.
    if (variance && *variance > 1e-12 * mean * mean) known.colours[c].variance = variance;
  }
  double survival = 0;
  for (const ZonedScene::Zone& z : law.zones) survival += z.fraction * steps.survival(z.surface);
  std::array<double, Tally::bounces> vertices{};
  vertices[0] = 1;
  vertices[1] = steps.splitting * steps.survival(law.zones[law.seen].surface);
  for (std::size_t k = 2; k < vertices.size(); ++k) vertices[k] = survival * vertices[k - 1];
  known.vertices = vertices;
  known.all_vertices = 1 + vertices[1] / (1 - survival);
}

std::vector<Channel> channels(const Scene& scene, const Knowledge& known) {
  std::vector<Channel> all;
  for (std::size_t c = 0; c < (scene.grey ? 1 : 3); ++c) {
    const Known& colour = known.colours[c];
    all.push_back({.name = scene.grey ? "radiance" : render::colours[c],
                   .mean = colour.mean,
                   .variance = colour.variance,
                   .low = known.low,
                   // Sums of some ten terms of about the mean's size.
                   .rounding = 1e-13 * colour.mean.value_or(0)});
  }
  all.push_back({.name = "vertices", .mean = known.all_vertices, .low = 0, .diagnostic = true});
  for (std::size_t k = 1; k < Tally::bounces; ++k) {
    Channel bounce{.name = "bounce_" + std::to_string(k), .low = 0, .diagnostic = true};
    if (known.vertices) bounce.mean = (*known.vertices)[k];
    all.push_back(bounce);
  }
  return all;
}

}  // namespace

Scene read_scene(Parameters& parameters) {
  const SceneDescription description =
      read_scene(parameters.structure("scene"), parameters.folder());
  Scene scene = std::visit([&](const auto& form) { return scene_of(form, description.camera); },
                           description.form);
  scene.grey = description.grey;
  return scene;
}

Knowledge knowledge(const Scene& scene, const std::optional<Steps>& steps) {
  Knowledge known;
  if (!scene.law) return known;
  const Rgb radiance = scene.law->seen_radiance();
  for (std::size_t c = 0; c < 3; ++c) known.colours[c].mean = radiance[c];
  if (steps) add_steps(known, scene, *steps);
  return known;
}

std::shared_ptr<const Setup> setup(const Scene& scene, const Knowledge& known, Trace trace,
                                   std::vector<NamedSampler> samplers, const Cost& cost) {
  const auto estimate = [trace = std::move(trace), grey = scene.grey](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& spent) {
    Tally tally;
    random.draw_ahead();
    for (std::uint64_t i = 0; i < primaries; ++i) trace(random, tally, spent);
    spent.samples += primaries;
    const double n = static_cast<double>(primaries);
    std::size_t at = 0;
    for (std::size_t c = 0; c < (grey ? 1 : 3); ++c) out[at++] = tally.value[c] / n;
    out[at++] = static_cast<double>(tally.vertices) / n;
    for (std::size_t k = 1; k < Tally::bounces; ++k) {
      out[at++] = static_cast<double>(tally.at_bounce[k]) / n;
    }
  };
  return setup_of({.channels = channels(scene, known),
                   .make = estimating(estimate),
                   .samplers = std::move(samplers),
                   .cost = cost});
}

ParameterInformation scene_parameter(std::string fallback) {
  return structure_parameter(
      "scene",
      "furnace, sphere, coloured_sphere or box, or a camera and one of zones, furnace and surfaces",
      std::move(fallback));
}

ParameterInformation direct_parameter() {
  return text_parameter(
      "direct",
      "how a path finds emitted light: by arriving at an emitter (hit), in closed form at every "
      "vertex (exact: spheres and furnaces), or by a shadow ray at every vertex (sampled)",
      "hit", {"hit", "exact", "sampled"});
}

Direct read_direct(Parameters& parameters, const Scene& scene) {
  const auto direct = parameters.choice<Direct>("direct");
  parameters.require(direct != Direct::exact || scene.law, "direct",
                     "exact direct light is known in spheres and furnaces only");
  parameters.require(direct != Direct::sampled || largest(scene.global.all) != 0, "direct",
                     "there is no light to sample: no surface emits");
  return direct;
}

NamedSampler direction_sampler() {
  const auto point = [](Stream& random) {
    const double u = random.uniform();
    return point_of(render::cosine_hemisphere(u, random.uniform()));
  };
  const auto density = [](const Point& w) { return w[2] / std::numbers::pi; };
  return {"direction", sampler_of({Domain::hemisphere, point, density})};
}

}  // namespace assay::paths
