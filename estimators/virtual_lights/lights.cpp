// Light after exactly two reflections, by virtual lights and by gathering.

#include "virtual_lights/lights.h"

#include <utility>

namespace assay::virtual_lights {

namespace {

std::vector<Channel> channels(const Scene& scene, const Recipe& recipe) {
  const std::optional<Rgb> known = twice_reflected(*scene.room);
  std::vector<Channel> all;
  for (std::size_t c = 0; c < (scene.grey ? 1 : 3); ++c) {
    Channel channel{.name = scene.grey ? "radiance" : render::colours[c], .low = 0};
    if (known) {
      channel.mean = (*known)[c];
      // Rounding of ratios of sums of thousands of terms.
      channel.rounding = 1e-12 * *channel.mean;
    }
    all.push_back(channel);
  }
  if (recipe.target) {
    all.push_back({.name = "target", .mean = recipe.target->value, .low = 0, .diagnostic = true});
  }
  return all;
}

void require_diffuse(Parameters& parameters, const paths::MeshWorld& world) {
  bool light = false;
  for (std::size_t i = 0; i < world.patches(); ++i) {
    const paths::Surface& surface = world.surface(i);
    parameters.require(surface.mirror == Rgb{}, "scene",
                       "a virtual light reflects diffusely: every `mirror` must be 0");
    light = light || render::largest(surface.emission) > 0;
  }
  parameters.require(light, "scene", "there is no light to shoot: no surface emits");
}

double given_target_integral(Parameters& parameters, const Room& room, Weighting weighting) {
  const Value& value = parameters.structure("target_integral");
  if (value.kind() == Value::Kind::scalar && value.string("target_integral") == "exact") {
    const Known known = target_integral(room, weighting);
    parameters.require(known.value.has_value(), "target_integral",
                       "`exact` is " + known.why_not + ". Give the integral as a number");
    return *known.value;
  }
  const double number = value.number("target_integral");
  parameters.require(number > 0 && number <= 1, "target_integral",
                     "must be `exact` or a number above 0 and at most 1: the target is a density");
  return number;
}

}  // namespace

Scene read_room(Parameters& parameters) {
  const paths::Scene scene = paths::read_scene(parameters);
  const auto* const world = std::get_if<paths::SharedMesh>(&scene.world);
  parameters.require(world, "scene", "virtual lights need triangles: a furnace or surfaces");
  require_diffuse(parameters, **world);
  const Vertex seen = (*world)->camera(Uncounted());
  parameters.require(seen.surface, "scene", "the camera sees no surface");
  parameters.require(seen.surface->diffuse != Rgb{}, "scene",
                     "the camera sees a surface of albedo 0, which reflects no light");
  const double shininess = parameters.number("shininess");
  // To the rounding of a direction that is given in decimals.
  parameters.require(!(shininess > 0) || dot(seen.arriving, seen.normal) <= -1 + 1e-9, "shininess",
                     "a glossy receiver must be seen along its normal, which its lobe is about");
  return {std::make_shared<const Room>(*world, shininess), scene.grey};
}

Weighted read_weighted(Parameters& parameters, SharedRoom room) {
  const auto weighting = parameters.choice<Weighting>("weighting");
  parameters.require(weighting != Weighting::marginal || room->why_no_marginal().empty(),
                     "weighting", "the marginal density is " + room->why_no_marginal());
  const double integral = given_target_integral(parameters, *room, weighting);
  return {{std::move(room)}, weighting, integral};
}

std::shared_ptr<const Setup> setup(const Scene& scene, Recipe recipe) {
  std::vector<Channel> its = channels(scene, recipe);
  const auto estimate = [recipe = std::move(recipe), grey = scene.grey](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& cost) {
    const double count = static_cast<double>(primaries);
    const Sums sums = recipe.sums(random, primaries, cost);
    const Rgb value = recipe.result(sums, count);
    std::size_t at = 0;
    for (std::size_t c = 0; c < (grey ? 1 : 3); ++c) out[at++] = value[c];
    if (recipe.target) out[at] = sums.target / count;
  };
  return setup_of({.channels = std::move(its),
                   .make = estimating(estimate),
                   .samplers = {paths::direction_sampler()},
                   .cost = {.camera_rays = 1}});
}

}  // namespace assay::virtual_lights

namespace assay::plugins {

namespace {

using namespace virtual_lights;

std::vector<ParameterInformation> room_parameters() {
  return {structure_parameter(
              "scene", "furnace or box, or a camera and one of furnace and surfaces", "furnace"),
          number_parameter("shininess",
                           "m of the receiver, which reflects a (m + 2) / (2 pi) cos^m towards a "
                           "camera straight above it; 0 is diffuse",
                           "0", {0, 1e6})};
}

Rgb gathered(const Room& room, bool sampled, Stream& random, Cost& cost) {
  const paths::MeshWorld& world = room.world();
  const Vertex first = world.reflected(room.receiver(), random, cost);
  if (!first.surface) return {};
  const double lobe = room.lobe(dot(first.arriving, room.receiver().normal));
  const Rgb albedo = lobe * room.receiver().surface->diffuse;
  if (sampled) {
    return albedo * world.direct_light(first, paths::Direct::sampled, random, cost);
  }
  const Vertex second = world.reflected(first, random, cost);
  if (!second.surface) return {};
  return albedo * first.surface->diffuse * second.surface->emission;
}

std::shared_ptr<const Setup> gather(Parameters& parameters) {
  const Scene scene = read_room(parameters);
  const bool sampled = parameters.string("direct") == "sampled";
  const auto sums = [room = scene.room, sampled](Stream& random, std::uint64_t primaries,
                                                 Cost& cost) {
    Sums all;
    for (std::uint64_t i = 0; i < primaries; ++i) {
      all.full += gathered(*room, sampled, random, cost);
    }
    cost.samples += primaries;
    return all;
  };
  return setup(scene, {sums, [](const Sums& all, double n) { return 1 / n * all.full; }});
}

}  // namespace

std::vector<Entry> virtual_lights_lights() {
  return {
      {{.name = "virtual_lights/classic",
        .summary = "Light after two reflections by virtual lights.",
        .description =
            "The radiance along the camera's ray of light that has been reflected exactly twice, "
            "at y1 and then at the receiver that the camera sees; all surfaces diffuse but for the "
            "receiver, where `shininess` says otherwise. A primary shoots light from a point y0 of "
            "what emits along a cosine-distributed direction to y1 and connects: X = Phi (a1 / pi) "
            "(a / pi) cos cos' V / r^2, Phi = pi sum of area x emitted radiance (Keller 1997). "
            "Unbiased; near corners rare primaries are large. In a closed room of even emission Le "
            "the mean is a Le sum F a1 over its walls, a^2 Le where all have the albedo a. Cost: a "
            "closest-hit ray, and a shadow ray where both cosines are positive. Channels: "
            "`radiance`, or `red`, `green`, `blue`. Sampler: direction.",
        .parameters = room_parameters()},
       [](Parameters& parameters) {
         const Scene scene = read_room(parameters);
         return setup(scene, recipe(Classic{scene.room}));
       }},
      {{.name = "virtual_lights/gather",
        .summary = "Light after two reflections by gathering: the trusted reference.",
        .description = "The integral of virtual_lights/classic by a path from the receiver: a "
                       "cosine-distributed ray to y1, and from there either another one, X = a a1 "
                       "Le, or a shadow ray to a point of what emits. Unbiased; without spikes by "
                       "`hit`, whose primary is a^2 Le always in a furnace.",
        .parameters =
            joined(room_parameters(),
                   {text_parameter("direct",
                                   "how y1 learns of emitted light: by a ray that arrives at what "
                                   "emits, or by a shadow ray to a point of it",
                                   "hit", {"hit", "sampled"})})},
       gather},
      {{.name = "virtual_lights/weighted",
        .summary = "Light after two reflections by virtual lights, weighted importance sampling.",
        .description =
            "The integral of virtual_lights/classic as G sum (f / p) / sum (g / p) over M light "
            "paths: f / p is its primary, g = cos cos' V / (pi r^2) the density with which the "
            "receiver would choose the virtual light y1 (times its lobe if it is glossy), p the "
            "density with which it was shot: conditional, cos0 cos1 / (pi r0^2) given the point y0 "
            "of what emits, or marginal, the irradiance of y1 over all power, by Lambert's "
            "formula. (Balazs, Szirmay-Kalos and Antal 2003.) G is the integral of g over what can "
            "be shot at: 5/6 in a cube that emits evenly, 1 less the form factor of the ceiling "
            "where that alone emits. Biased, and consistent only with the right G. The bias falls "
            "like 1/M where g / p has a variance; with the conditional density it has none, since "
            "E[(g/p)^2] grows without bound where y1 is near the edge of the wall of y0, and the "
            "bias falls more slowly. Where emission is even and the density marginal f / g is "
            "constant, and the estimate exact. Diagnostic channel: `target`, the mean of g / p, "
            "whose expectation is G. Rays as virtual_lights/classic.",
        .parameters = joined(
            room_parameters(),
            {text_parameter("weighting",
                            "the shooting density that the target is divided by: of the virtual "
                            "light given where the light comes from, or whatever that is",
                            "conditional", {"conditional", "marginal"}),
             structure_parameter(
                 "target_integral",
                 "G, the integral of the target over what the shooting can reach: exact (closed "
                 "rooms, convex or, marginal, of even emission) or a number in (0, 1]",
                 "exact")}),
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       // The target g has the spikes of f, so that the ratio has none. If g/p has a variance, the
       // bias to first order is (I Var(g/p) / G^2 - Cov(f/p, g/p) / G) / M.
       [](Parameters& parameters) {
         const Scene scene = read_room(parameters);
         return setup(scene, weighted_recipe(read_weighted(parameters, scene.room)));
       }}};
}

}  // namespace assay::plugins
