#include <numbers>

#include "estimators/core/mapped.h"
#include "paths/family.h"

namespace assay::paths {

namespace {

constexpr std::size_t local_rays = 256;

std::vector<Surface> patch_surfaces(const Scene& scene) {
  if (const auto* const mesh = std::get_if<SharedMesh>(&scene.world)) {
    return mapped_indices((*mesh)->patches(), [&](std::size_t i) { return (*mesh)->surface(i); });
  }
  return mapped(scene.law->zones, &ZonedScene::Zone::surface);
}

// The number of bounces of a path with roulette in a furnace, the last cell for all beyond.
class Lengths final : public Sampler {
 public:
  Lengths(SharedMesh world, Roulette roulette, double survival)
      : world_(std::move(world)), roulette_(std::move(roulette)), survival_(survival) {}
  Domain domain() const override { return Domain::interval; }
  int lobes() const override { return cells; }
  SamplerDraw sample(Stream& random) const override {
    Tally tally;
    trace(*world_, roulette_, Direct::hit, random, tally, Uncounted());
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

ParameterInformation rule_parameter() {
  return text_parameter(
      "rule",
      "the probability to go on: the largest albedo, its mean over the colours, its luminance, its "
      "mean weighted with the throughput, or with throughput x mean radiance",
      "max_albedo", {"max_albedo", "mean_albedo", "luminance", "throughput", "radiance"});
}

/// The terminal value e of a surface: scale x albedo x arriving radiance. If direct light is found
/// separately, its part of the diffuse reflection is left out.
Rgb terminal_value(const Surface& surface, const Incoming& incoming, Direct direct, double scale) {
  const Rgb& diffuse = direct == Direct::hit ? incoming.all : incoming.reflected;
  return scale * (surface.diffuse * diffuse + surface.mirror * incoming.all);
}

}  // namespace

std::vector<Rgb> global_terminal(const Scene& scene, const Incoming& incoming, Direct direct,
                                 double scale) {
  return mapped(patch_surfaces(scene), [&](const Surface& surface) {
    return terminal_value(surface, incoming, direct, scale);
  });
}

RoulettePlan read_classical(Parameters& parameters, const Scene& scene) {
  return {.rule = parameters.choice<Rule>("rule"), .direct = read_direct(parameters, scene)};
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
  parameters.require(mesh, "terminal",
                     "inside a sphere the same light arrives everywhere: use `global`");
  const std::vector<Incoming> local = local_incoming(**mesh, local_rays, plan.cost);
  plan.terminal = mapped_indices(local.size(), [&](std::size_t i) {
    return terminal_value((*mesh)->surface(i), local[i], plan.direct, plan.scale);
  });
  return plan;
}

}  // namespace assay::paths

namespace assay::plugins {

namespace {

using namespace paths;

/// The steps of zones where the probability to go on depends on the zone alone.
std::optional<Steps> exact_steps(const Scene& scene, const RoulettePlan& plan) {
  const bool by_surface = plan.rule == Rule::max_albedo || plan.rule == Rule::mean_albedo ||
                          plan.rule == Rule::luminance;
  if (!scene.law || (!scene.grey && !by_surface)) return {};
  // A local estimate of a furnace is rough.
  if (!plan.terminal.empty() && !plan.incoming) return {};
  const Roulette roulette = plan.roulette(scene);
  const auto survival = [roulette](const Surface& surface) {
    return roulette.survival(Rgb::grey(1), surface).total();
  };
  const auto terminal = [incoming = plan.incoming.value_or(Incoming{}), direct = plan.direct,
                         scale = plan.scale](const Surface& surface) {
    return terminal_value(surface, incoming, direct, scale);
  };
  return Steps{.survival = survival, .terminal = terminal, .direct = plan.direct};
}

template <class Plan>
std::shared_ptr<const Setup> prepared(Parameters& parameters, const Plan& plan_of) {
  const Scene scene = paths::read_scene(parameters);
  const RoulettePlan plan = plan_of(parameters, scene);
  Knowledge known = knowledge(scene, exact_steps(scene, plan));
  if (plan.terminal.empty()) known.low = 0;
  std::vector<NamedSampler> samplers = {direction_sampler()};
  if (const auto* const sphere = std::get_if<SharedSphere>(&scene.world)) {
    // The point where a reflected ray arrives: uniform in area.
    const auto hit = [world = *sphere](Stream& random) {
      return point_of(world->reflected(world->camera(Uncounted()), random, Uncounted()).position);
    };
    samplers.push_back(
        {"hit", sampler_of({Domain::sphere, hit, uniform_density(1 / (4 * std::numbers::pi))})});
  } else if (known.vertices) {
    samplers.push_back(
        {"length", std::make_shared<Lengths>(std::get<SharedMesh>(scene.world),
                                             plan.roulette(scene), (*known.vertices)[1])});
  }
  return setup_in_world(
      scene, known,
      [roulette = plan.roulette(scene), direct = plan.direct](const auto& world, auto&... run) {
        trace(world, roulette, direct, run...);
      },
      std::move(samplers), plan.cost);
}

// Go with the winners: paths that split where a large error is anticipated and end elsewhere.
std::shared_ptr<const Setup> winners(Parameters& parameters) {
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

std::vector<Entry> paths_roulette() {
  return {
      {{.name = "paths/roulette",
        .summary = "Radiance by paths that end by classical Russian roulette.",
        .description =
            "Goes on with probability s and multiplies the throughput T by a / s. s by `rule`, a "
            "the albedo: max_albedo, mean_albedo, luminance (of a), throughput (sum T a / sum T), "
            "radiance (sum T a L / sum T L, L the scene's mean radiance for each colour); equal in "
            "grey scenes. A mirror is chosen in proportion to the rule's value for it. Unbiased "
            "for every rule. `direct` says how a path finds emitted light. Mean exact in spheres "
            "and furnaces, variance there too where s depends on the surface alone: in a grey "
            "furnace Le^2 a / (1 - a)^2. Diagnostic channels: vertices, bounce_1 to bounce_6. "
            "Cost: a camera ray, a closest-hit ray a bounce, a shadow ray where one is traced. "
            "Samplers: direction; in spheres hit (where a reflected ray arrives, uniform on the "
            "sphere); length (the number of bounces, in a furnace where the law is known).",
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
        .parameters =
            {scene_parameter("furnace"), rule_parameter(), direct_parameter(),
             text_parameter(
                 "terminal",
                 "where the terminal value comes from: one estimate for the scene, or one "
                 "for each side of each triangle",
                 "global", {"global", "local"}),
             number_parameter("scale",
                              "factor of the terminal value: 1 where the estimate is trusted, 0 is "
                              "the classical roulette",
                              "1", {0, 1000})}},
       [](Parameters& p) { return prepared(p, read_improved); }},
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
       winners}};
}

}  // namespace assay::plugins
