// Mutants of paths with roulette: the sound parts with one replaced.

#include <utility>

#include "estimators/mutant.h"
#include "paths/roulette_setup.h"

namespace assay::plugins {

namespace {

using namespace paths;

// Replacements for parts of the roulette.

struct TerminalNotSubtracted : Roulette {
  Spectrum on_going_on(const Spectrum&, double) const { return {}; }
};

struct ThroughputNotDivided : Roulette {
  Spectrum continued(const Spectrum& throughput, const Spectrum& reflectance, double) const {
    return throughput * reflectance;
  }
};

struct DarkSurfacesEnd : Roulette {
  Survival survival(const Spectrum& throughput, const Surface& surface) const {
    return largest(surface.albedo()) < 0.3 ? Survival{} : Roulette::survival(throughput, surface);
  }
};

struct SurvivalAboveOne : Roulette {
  Survival survival(const Spectrum& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    return {1.2 * s.diffuse, 1.2 * s.mirror};
  }
};

struct DividedByItself : Roulette {
  Spectrum continued(const Spectrum& throughput, const Spectrum&, double) const {
    return throughput;
  }
};

struct ClampedSurvival : Roulette {
  Survival survival(const Spectrum& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    const double factor = s.total() > 0 ? std::max(s.total(), 0.5) / s.total() : 0;
    return {factor * s.diffuse, factor * s.mirror};
  }
  Spectrum continued(const Spectrum& throughput, const Spectrum& reflectance, double) const {
    return 1 / rule(throughput, reflectance) * (throughput * reflectance);
  }
};

struct DarkPathsKilled : Roulette {
  Survival survival(const Spectrum& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    return s.total() < 0.1 ? Survival{} : s;
  }
};

struct LuminanceThroughput : Roulette {
  Spectrum continued(const Spectrum& throughput, const Spectrum& reflectance,
                     double probability) const {
    return Spectrum::grey(luminance(Roulette::continued(throughput, reflectance, probability)));
  }
};

struct SurvivalAfterUpdate : Roulette {
  Spectrum continued(const Spectrum& throughput, const Spectrum& reflectance, double) const {
    const Spectrum outgoing = throughput * reflectance;
    return 1 / rule(outgoing, reflectance) * outgoing;
  }
};

// A world whose rays come to nothing from the ninth reflection on; made anew for each path.
template <class World>
class EightReflections {
 public:
  explicit EightReflections(const World& world) : world_(world) {}

  Vertex camera(Cost& cost) const { return world_.camera(cost); }
  Vertex reflected(const Vertex& from, Stream& random, Cost& cost) const {
    const Vertex next = world_.reflected(from, random, cost);
    return ++reflections_ > 8 ? Vertex{} : next;
  }
  Vertex mirrored(const Vertex& from, Cost& cost) const {
    const Vertex next = world_.mirrored(from, cost);
    return ++reflections_ > 8 ? Vertex{} : next;
  }
  Spectrum direct_light(const Vertex& v, Direct direct, Stream& random, Cost& cost) const {
    return world_.direct_light(v, direct, random, cost);
  }

 private:
  const World& world_;
  mutable int reflections_ = 0;
};

Spectrum brighter(const Spectrum& a, const Spectrum& b) {
  return {std::max(a.red, b.red), std::max(a.green, b.green), std::max(a.blue, b.blue)};
}

// A path whose terminal value is raised to what it finds when it goes on, before that is taken off.
template <class World>
void trace_hindsight(const World& world, const Roulette& roulette, Stream& random, Tally& tally,
                     Cost& cost) {
  Spectrum throughput = Spectrum::grey(1);
  Vertex v = world.camera(cost);
  for (std::size_t bounce = 0; v.surface; ++bounce) {
    tally.count(bounce);
    tally.value += throughput * v.surface->emission;
    const Surface& surface = *v.surface;
    const Survival s = roulette.survival(throughput, surface);
    const Spectrum terminal = roulette.terminal(v);
    const double u = random.uniform();
    if (u >= s.total()) {
      tally.value += throughput * roulette.on_end(terminal);
      return;
    }
    const bool mirror = u >= s.diffuse;
    v = mirror ? world.mirrored(v, cost) : world.reflected(v, random, cost);
    const Spectrum found = v.surface ? surface.albedo() * v.surface->emission : Spectrum{};
    tally.value += throughput * roulette.on_going_on(brighter(terminal, found), s.total());
    throughput = mirror ? roulette.continued(throughput, surface.mirror, s.mirror)
                        : roulette.continued(throughput, surface.diffuse, s.diffuse);
  }
}

// Entries.

struct Kind {
  const char* original;
  RoulettePlan (*read)(Parameters&, const Scene&);
};

constexpr Kind classical = {"paths/roulette", read_classical};
constexpr Kind improved = {"paths/improved_roulette", read_improved};

struct Defect {
  std::string name;
  std::string what;
};

// `broken` makes a trace from a shared world, a sound roulette and how light is learnt of.
template <class MakeTrace>
Entry entry(const Kind& kind, const Defect& defect, const MakeTrace& trace_of) {
  return mutant({defect.name, kind.original, defect.what},
                [kind, trace_of](Parameters& parameters) {
                  const Scene scene = paths::read_scene(parameters);
                  const RoulettePlan plan = kind.read(parameters, scene);
                  return with_world(scene, [&](const auto& world) {
                    return mutant_setup(scene, trace_of(world, plan.roulette(scene), plan.direct));
                  });
                });
}

template <class Broken>
Entry roulette_mutant(const Kind& kind, const Defect& defect) {
  return entry(kind, defect, [](const auto& world, const Roulette& sound, Direct direct) -> Trace {
    return [world, broken = Broken{sound}, direct](Stream& random, Tally& tally, Cost& cost) {
      trace(*world, broken, direct, random, tally, cost);
    };
  });
}

Trace depth_limited(const auto& world, const Roulette& sound, Direct direct) {
  return [world, sound, direct](Stream& random, Tally& tally, Cost& cost) {
    const EightReflections shallow(*world);
    trace(shallow, sound, direct, random, tally, cost);
  };
}

// Twice counted: e as if light were learnt of by hits, whatever the way it is learnt of.
std::shared_ptr<const Setup> direct_light_twice(Parameters& parameters) {
  const Scene scene = paths::read_scene(parameters);
  const RoulettePlan plan = read_improved(parameters, scene);
  const Roulette broken(
      plan.rule, scene.global.all,
      global_terminal(scene, plan.incoming.value_or(scene.global), Direct::hit, plan.scale));
  return with_world(scene, [&](const auto& world) {
    return mutant_setup(
        scene, [world, broken, direct = plan.direct](Stream& random, Tally& tally, Cost& cost) {
          trace(*world, broken, direct, random, tally, cost);
        });
  });
}

// With survival above 1 everywhere a path would never end.
std::shared_ptr<const Setup> survival_above_one(Parameters& parameters) {
  const Scene scene = paths::read_scene(parameters);
  const RoulettePlan plan = read_classical(parameters, scene);
  bool ends = !scene.law;
  if (scene.law) {
    for (const ZonedScene::Zone& zone : scene.law->zones) {
      ends = ends || largest(zone.surface.albedo()) < 0.8;
    }
  }
  if (!ends) parameters.refuse("scene", "where every albedo is 0.8 or more, its paths never end");
  return with_world(scene, [&](const auto& world) {
    return mutant_setup(scene, [world, broken = SurvivalAboveOne{plan.roulette(scene)},
                                direct = plan.direct](Stream& random, Tally& tally, Cost& cost) {
      trace(*world, broken, direct, random, tally, cost);
    });
  });
}

}  // namespace

std::vector<Entry> mutants_roulette() {
  return {
      roulette_mutant<TerminalNotSubtracted>(
          improved, {"terminal_not_subtracted",
                     "adds the terminal value at the end and takes nothing off when going on; +50 "
                     "% in a furnace of albedo 0.5."}),
      roulette_mutant<ThroughputNotDivided>(classical,
                                            {"throughput_not_divided",
                                             "does not divide the throughput by the probability to "
                                             "go on; -33 % in a furnace of albedo 0.5."}),
      entry(classical,
            {"depth_limit",
             "loses what comes after eight reflections; -0.2 % in a furnace of albedo 0.5, -13.4 "
             "% of albedo 0.8."},
            [](const auto& world, const Roulette& sound, Direct direct) {
              return depth_limited(world, sound, direct);
            }),
      entry(improved,
            {"terminal_from_hindsight",
             "raises the terminal value to what the path finds when it goes on; learns of light by "
             "hits whatever `direct` says. Nothing in a furnace, -10 % in the built-in sphere."},
            [](const auto& world, const Roulette& sound, Direct) -> Trace {
              return [world, sound](Stream& random, Tally& tally, Cost& cost) {
                trace_hindsight(*world, sound, random, tally, cost);
              };
            }),
      mutant({"direct_light_twice", improved.original,
              "leaves the direct light in the terminal value although it is learnt "
              "of separately: still unbiased, but of a larger variance."},
             direct_light_twice),
      roulette_mutant<DarkSurfacesEnd>(
          classical, {"dark_surfaces_end",
                      "never goes on from surfaces whose albedo is below 0.3, and counts nothing "
                      "for it; too dark where there are such surfaces."}),
      mutant({"survival_above_one", classical.original,
              "goes on with 1.2 times the probability and divides by all of it, "
              "above 1, too; too dark where an albedo exceeds 5/6."},
             survival_above_one),
      roulette_mutant<DividedByItself>(
          classical, {"divided_by_itself",
                      "divides each colour by its own albedo, so that the throughput stays what it "
                      "was; saturated surfaces come out grey: +184 %, +950 % and +2060 % in the "
                      "built-in coloured sphere."}),
      roulette_mutant<ClampedSurvival>(
          classical, {"clamped_survival",
                      "goes on with probability 1/2 at least, and divides by what it was before; "
                      "too bright where it was below: +67 %, +120 % and +139 % in the coloured "
                      "sphere by the throughput."}),
      roulette_mutant<DarkPathsKilled>(classical,
                                       {"dark_paths_killed",
                                        "ends paths whose probability to go on is below 0.1 "
                                        "without compensation; too dark where there are such."}),
      roulette_mutant<LuminanceThroughput>(
          classical, {"luminance_throughput",
                      "keeps of the throughput its luminance alone; colours are lost: -58 %, +55 % "
                      "and +219 % in the coloured sphere by the throughput."}),
      roulette_mutant<SurvivalAfterUpdate>(
          classical,
          {"survival_after_update",
           "decides by the throughput before the reflection and divides by the probability that "
           "follows from the one after it; -48 %, -53 % and -55 % in the coloured sphere by the "
           "throughput, nothing in grey scenes or by rules of the albedo alone."}),
  };
}

}  // namespace assay::plugins
