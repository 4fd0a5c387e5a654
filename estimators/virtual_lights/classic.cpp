// Light after exactly two reflections, by virtual lights and by gathering.
//
// Classic: light is shot from a point y0 of an emitter, in proportion to its radiance, along a
// cosine-distributed direction to y1. That is a virtual light (Keller 1997, "Instant radiosity"):
//   X = Phi (a1 / pi) (a / pi) cos cos' V / r^2, Phi the power of a path.
// X is unbiased, but 1 / r^2 makes spikes near the virtual light.
//
// Gathering: a ray from the receiver to y1 and one from there to y0, X = a a1 Le. It shares the
// scene with the others and nothing of their shooting: the trusted reference.

#include "virtual_lights/family.h"

namespace assay::plugins {

namespace {

using namespace virtual_lights;

std::shared_ptr<const Setup> classic(Parameters& parameters) {
  const Scene scene = read_room(parameters);
  return setup(scene, recipe(Classic{scene.room}));
}

Spectrum gathered(const Room& room, bool sampled, Stream& random, Cost& cost) {
  const paths::MeshWorld& world = room.world();
  const Vertex first = world.reflected(room.receiver(), random, cost);
  if (!first.surface) return {};
  const double lobe = room.lobe(dot(first.arriving, room.receiver().normal));
  const Spectrum albedo = lobe * room.receiver().surface->diffuse;
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

std::vector<ParameterInformation> gather_parameters() {
  std::vector<ParameterInformation> all = room_parameters();
  all.push_back({.name = "direct",
                 .type = ParameterType::string,
                 .summary =
                     "how y1 learns of emitted light: by a ray that arrives at what emits, or "
                     "by a shadow ray to a point of it",
                 .fallback = "hit",
                 .choices = {"hit", "sampled"}});
  return all;
}

}  // namespace

std::vector<Entry> virtual_lights_classic() {
  return {
      {{.name = "virtual_lights/classic",
        .summary = "Light after two reflections by virtual lights.",
        .description =
            "The radiance along the camera's ray of light that has been reflected exactly twice, "
            "at y1 and then at the receiver that the camera sees; all surfaces diffuse but for the "
            "receiver, where `shininess` says otherwise. A primary "
            "shoots light from a point y0 of what emits along a cosine-distributed direction to "
            "y1 and connects: X = Phi (a1 / pi) (a / pi) cos cos' V / r^2, Phi = pi sum of area x "
            "emitted radiance (Keller 1997). Unbiased; near corners rare primaries are large. In "
            "a closed room of even emission Le the mean is a Le sum F a1 over its walls, a^2 Le "
            "where all have the albedo a. Cost: a closest-hit ray, and a shadow ray where both "
            "cosines are positive. Channels: `radiance`, or `red`, `green`, `blue`. Sampler: "
            "direction.",
        .parameters = room_parameters()},
       classic},
      {{.name = "virtual_lights/gather",
        .summary = "Light after two reflections by gathering: the trusted reference.",
        .description =
            "The integral of virtual_lights/classic by a path from the receiver: a "
            "cosine-distributed ray to y1, and from there either another one, X = a a1 Le, or a "
            "shadow ray to a point of what emits. Unbiased; without spikes by `hit`, whose primary "
            "is a^2 Le always in a furnace.",
        .parameters = gather_parameters()},
       gather}};
}

}  // namespace assay::plugins
