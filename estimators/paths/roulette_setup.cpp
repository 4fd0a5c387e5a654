#include "paths/roulette_setup.h"

#include <numbers>

#include "paths/path.h"

namespace assay::paths {

namespace {

constexpr std::size_t local_rays = 256;

std::vector<Surface> patch_surfaces(const Scene& scene) {
  std::vector<Surface> all;
  if (const auto* const mesh = std::get_if<SharedMesh>(&scene.world)) {
    for (std::size_t i = 0; i < (*mesh)->patches(); ++i) all.push_back((*mesh)->surface(i));
  } else {
    for (const ZonedScene::Zone& zone : scene.law->zones) all.push_back(zone.surface);
  }
  return all;
}

// The point where a reflected ray arrives in a sphere: uniform in area.
class SphereHits final : public Sampler {
 public:
  explicit SphereHits(SharedSphere world) : world_(std::move(world)) {}
  Domain domain() const override { return Domain::sphere; }
  SamplerDraw sample(Stream& random) const override {
    Cost uncounted;
    const Vertex hit = world_->reflected(world_->camera(uncounted), random, uncounted);
    const Point point = {hit.position.x, hit.position.y, hit.position.z};
    return {.point = point, .density = density(point), .weight = 1};
  }
  double density(const Point&) const override { return 1 / (4 * std::numbers::pi); }
  double evaluate(const Point&) const override { return 1 / (4 * std::numbers::pi); }

 private:
  SharedSphere world_;
};

// The number of bounces of a path with roulette in a furnace, the last cell for all beyond.
class Lengths final : public Sampler {
 public:
  Lengths(SharedMesh world, Roulette roulette, double survival)
      : world_(std::move(world)), roulette_(std::move(roulette)), survival_(survival) {}
  Domain domain() const override { return Domain::interval; }
  int lobes() const override { return cells; }
  SamplerDraw sample(Stream& random) const override {
    Cost uncounted;
    Tally tally;
    trace(*world_, roulette_, Direct::hit, random, tally, uncounted);
    return {.density = 0,
            .weight = 1,
            .lobe = static_cast<int>(std::min<std::uint64_t>(tally.vertices, cells) - 1)};
  }
  double density(const Point&) const override { return 0; }
  double evaluate(const Point&) const override { return 0; }
  double point_mass(int lobe) const override {
    const double reached = std::pow(survival_, lobe);
    return lobe + 1 == cells ? reached : reached * (1 - survival_);
  }

 private:
  static constexpr int cells = 12;
  SharedMesh world_;
  Roulette roulette_;
  double survival_;
};

}  // namespace

Spectrum terminal_value(const Surface& surface, const Incoming& incoming, Direct direct,
                        double scale) {
  const Spectrum& diffuse = direct == Direct::hit ? incoming.all : incoming.reflected;
  return scale * (surface.diffuse * diffuse + surface.mirror * incoming.all);
}

std::vector<Spectrum> global_terminal(const Scene& scene, const Incoming& incoming, Direct direct,
                                      double scale) {
  std::vector<Spectrum> all;
  for (const Surface& surface : patch_surfaces(scene)) {
    all.push_back(terminal_value(surface, incoming, direct, scale));
  }
  return all;
}

RoulettePlan read_classical(Parameters& parameters, const Scene& scene) {
  return {.rule = read_rule(parameters), .direct = read_direct(parameters, scene)};
}

RoulettePlan read_improved(Parameters& parameters, const Scene& scene) {
  RoulettePlan plan = read_classical(parameters, scene);
  plan.scale = parameters.number("scale");
  if (parameters.string("terminal") == "global") {
    plan.incoming = scene.global;
    plan.terminal = global_terminal(scene, scene.global, plan.direct, plan.scale);
    return plan;
  }
  const auto* const mesh = std::get_if<SharedMesh>(&scene.world);
  if (!mesh) {
    parameters.refuse("terminal",
                      "inside a sphere the same light arrives everywhere: use `global`");
  }
  const std::vector<Incoming> local = local_incoming(**mesh, local_rays, plan.cost);
  for (std::size_t i = 0; i < local.size(); ++i) {
    plan.terminal.push_back(terminal_value((*mesh)->surface(i), local[i], plan.direct, plan.scale));
  }
  return plan;
}

std::vector<ParameterInformation> improved_parameters() {
  return {scene_parameter("furnace"),
          rule_parameter(),
          direct_parameter(),
          {.name = "terminal",
           .type = ParameterType::string,
           .summary = "where the terminal value comes from: one estimate for the scene, or one for "
                      "each side of each triangle",
           .fallback = "global",
           .choices = {"global", "local"}},
          {.name = "scale",
           .summary = "factor of the terminal value: 1 where the estimate is trusted, 0 is the "
                      "classical roulette",
           .fallback = "1",
           .low = 0,
           .high = 1000}};
}

std::optional<Steps> exact_steps(const Scene& scene, const RoulettePlan& plan) {
  const bool by_surface = plan.rule == Rule::max_albedo || plan.rule == Rule::mean_albedo ||
                          plan.rule == Rule::luminance;
  if (!scene.law || (!scene.grey && !by_surface)) return {};
  // A local estimate of a furnace is rough.
  if (!plan.terminal.empty() && !plan.incoming) return {};
  const Roulette roulette = plan.roulette(scene);
  const auto survival = [roulette](const Surface& surface) {
    return roulette.survival(Spectrum::grey(1), surface).total();
  };
  const auto terminal = [incoming = plan.incoming.value_or(Incoming{}), direct = plan.direct,
                         scale = plan.scale](const Surface& surface) {
    return terminal_value(surface, incoming, direct, scale);
  };
  return Steps{.survival = survival, .terminal = terminal, .direct = plan.direct};
}

std::vector<NamedSampler> samplers_of(const Scene& scene, const RoulettePlan& plan,
                                      const Knowledge& known) {
  std::vector<NamedSampler> all = {direction_sampler()};
  if (const auto* const sphere = std::get_if<SharedSphere>(&scene.world)) {
    all.push_back({"hit", std::make_shared<SphereHits>(*sphere)});
  } else if (known.vertices) {
    all.push_back(
        {"length", std::make_shared<Lengths>(std::get<SharedMesh>(scene.world),
                                             plan.roulette(scene), (*known.vertices)[1])});
  }
  return all;
}

}  // namespace assay::paths
