#include "virtual_lights/family.h"

#include <utility>

namespace assay::virtual_lights {

namespace {

using Pick = double Spectrum::*;
constexpr std::array<Pick, 3> colours = {&Spectrum::red, &Spectrum::green, &Spectrum::blue};
constexpr std::array<const char*, 3> colour_names = {"red", "green", "blue"};

class LightsEstimator final : public Estimator {
 public:
  LightsEstimator(Recipe recipe, bool grey) : recipe_(std::move(recipe)), grey_(grey) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    const double count = static_cast<double>(primaries);
    const Sums sums = recipe_.sums(random, primaries, cost);
    const Spectrum value = recipe_.result(sums, count);
    std::size_t at = 0;
    for (const Pick colour : colours) {
      if (at == 0 || !grey_) out[at++] = value.*colour;
    }
    if (recipe_.has_target) out[at] = sums.target / count;
  }

 private:
  Recipe recipe_;
  bool grey_;
};

std::vector<Channel> channels(const Scene& scene, const Recipe& recipe) {
  const std::optional<Spectrum> known = twice_reflected(*scene.room);
  std::vector<Channel> all;
  for (std::size_t c = 0; c < (scene.grey ? 1 : 3); ++c) {
    Channel channel{.name = scene.grey ? "radiance" : colour_names[c], .low = 0};
    if (known) {
      channel.mean = (*known).*colours[c];
      // Rounding of ratios of sums of thousands of terms.
      channel.rounding = 1e-12 * *channel.mean;
    }
    all.push_back(channel);
  }
  if (recipe.has_target) {
    all.push_back({.name = "target", .mean = recipe.target.value, .low = 0, .diagnostic = true});
  }
  return all;
}

void require_diffuse(Parameters& parameters, const paths::MeshWorld& world) {
  bool light = false;
  for (std::size_t i = 0; i < world.patches(); ++i) {
    const paths::Surface& surface = world.surface(i);
    if (!(surface.mirror == Spectrum{})) {
      parameters.refuse("scene", "a virtual light reflects diffusely: every `mirror` must be 0");
    }
    light = light || paths::largest(surface.emission) > 0;
  }
  if (!light) parameters.refuse("scene", "there is no light to shoot: no surface emits");
}

void require_receiver(Parameters& parameters, const paths::MeshWorld& world) {
  Cost uncounted;
  const Vertex seen = world.camera(uncounted);
  if (!seen.surface) parameters.refuse("scene", "the camera sees no surface");
  if (seen.surface->diffuse == Spectrum{}) {
    parameters.refuse("scene", "the camera sees a surface of albedo 0, which reflects no light");
  }
}

double read_shininess(Parameters& parameters, const paths::MeshWorld& world) {
  const double shininess = parameters.number("shininess");
  Cost uncounted;
  const Vertex seen = world.camera(uncounted);
  // To the rounding of a direction that is given in decimals.
  if (shininess > 0 && dot(seen.arriving, seen.normal) > -1 + 1e-9) {
    parameters.refuse("shininess",
                      "a glossy receiver must be seen along its normal, which its lobe is about");
  }
  return shininess;
}

double given_target_integral(Parameters& parameters, const Room& room, Weighting weighting) {
  const Value& value = parameters.structure("target_integral");
  if (value.kind() == Value::Kind::scalar && value.string("target_integral") == "exact") {
    const Known known = target_integral(room, weighting);
    if (!known.value) {
      parameters.refuse("target_integral",
                        "`exact` is " + known.why_not + ". Give the integral as a number");
    }
    return *known.value;
  }
  const double number = value.number("target_integral");
  if (!std::isfinite(number) || number <= 0 || number > 1) {
    parameters.refuse("target_integral",
                      "must be `exact` or a number above 0 and at most 1: the target is a density");
  }
  return number;
}

}  // namespace

Scene read_room(Parameters& parameters) {
  const paths::Scene scene = paths::read_scene(parameters);
  const auto* const world = std::get_if<paths::SharedMesh>(&scene.world);
  if (!world) parameters.refuse("scene", "virtual lights need triangles: a furnace or surfaces");
  require_diffuse(parameters, **world);
  require_receiver(parameters, **world);
  const double shininess = read_shininess(parameters, **world);
  return {std::make_shared<const Room>(*world, shininess), scene.grey};
}

Weighted read_weighted(Parameters& parameters, SharedRoom room) {
  const bool marginal = parameters.string("weighting") == "marginal";
  const Weighting weighting = marginal ? Weighting::marginal : Weighting::conditional;
  if (marginal && !room->why_no_marginal().empty()) {
    parameters.refuse("weighting", "the marginal density is " + room->why_no_marginal());
  }
  const double integral = given_target_integral(parameters, *room, weighting);
  return {{std::move(room)}, weighting, integral};
}

std::vector<ParameterInformation> room_parameters() {
  return {{.name = "scene",
           .type = ParameterType::structure,
           .summary = "furnace or box, or a camera and one of furnace and surfaces",
           .fallback = "furnace"},
          {.name = "shininess",
           .summary = "m of the receiver, which reflects a (m + 2) / (2 pi) cos^m towards a camera "
                      "straight above it; 0 is diffuse",
           .fallback = "0",
           .low = 0,
           .high = 1e6}};
}

std::vector<ParameterInformation> weighted_parameters() {
  std::vector<ParameterInformation> all = room_parameters();
  all.insert(
      all.end(),
      {{.name = "weighting",
        .type = ParameterType::string,
        .summary = "the shooting density that the target is divided by: of the virtual light given "
                   "where the light comes from, or whatever that is",
        .fallback = "conditional",
        .choices = {"conditional", "marginal"}},
       {.name = "target_integral",
        .type = ParameterType::structure,
        .summary = "G, the integral of the target over what the shooting can reach: exact (closed "
                   "rooms, convex or, marginal, of even emission) or a number in (0, 1]",
        .fallback = "exact"}});
  return all;
}

std::shared_ptr<const Setup> setup(const Scene& scene, Recipe recipe) {
  std::vector<Channel> its = channels(scene, recipe);
  return setup_of(
      {.channels = std::move(its),
       .make = [recipe = std::move(recipe),
                grey = scene.grey] { return std::make_unique<LightsEstimator>(recipe, grey); },
       .samplers = {paths::direction_sampler()},
       .cost = {.camera_rays = 1}});
}

}  // namespace assay::virtual_lights
