// Mutants of paths with roulette and of go with the winners: the sound parts with one replaced.

#include <algorithm>

#include "estimators/mutant.h"
#include "paths/family.h"
#include "paths/path.h"

namespace assay::plugins {

namespace {

using namespace paths;

// Replacements for parts of the roulette.

struct TerminalNotSubtracted : Roulette {
  Rgb on_going_on(const Rgb&, double, const Surface&, const Vertex&) const { return {}; }
};

struct TerminalFromHindsight : Roulette {
  Rgb on_going_on(const Rgb& terminal, double survival, const Surface& from,
                  const Vertex& next) const {
    const Rgb found = next.surface ? from.albedo() * next.surface->emission : Rgb{};
    return Roulette::on_going_on(brighter(terminal, found), survival, from, next);
  }
};

struct ThroughputNotDivided : Roulette {
  Rgb continued(const Rgb& throughput, const Rgb& reflectance, double) const {
    return throughput * reflectance;
  }
};

struct DarkSurfacesEnd : Roulette {
  Survival survival(const Rgb& throughput, const Surface& surface) const {
    return largest(surface.albedo()) < 0.3 ? Survival{} : Roulette::survival(throughput, surface);
  }
};

struct SurvivalAboveOne : Roulette {
  Survival survival(const Rgb& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    return {1.2 * s.diffuse, 1.2 * s.mirror};
  }
};

struct DividedByItself : Roulette {
  Rgb continued(const Rgb& throughput, const Rgb&, double) const { return throughput; }
};

struct ClampedSurvival : Roulette {
  Survival survival(const Rgb& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    const double factor = s.total() > 0 ? std::max(s.total(), 0.5) / s.total() : 0;
    return {factor * s.diffuse, factor * s.mirror};
  }
  Rgb continued(const Rgb& throughput, const Rgb& reflectance, double) const {
    return 1 / rule(throughput, reflectance) * (throughput * reflectance);
  }
};

struct DarkPathsKilled : Roulette {
  Survival survival(const Rgb& throughput, const Surface& surface) const {
    const Survival s = Roulette::survival(throughput, surface);
    return s.total() < 0.1 ? Survival{} : s;
  }
};

struct LuminanceThroughput : Roulette {
  Rgb continued(const Rgb& throughput, const Rgb& reflectance, double probability) const {
    return Rgb::grey(luminance(Roulette::continued(throughput, reflectance, probability)));
  }
};

struct SurvivalAfterUpdate : Roulette {
  Rgb continued(const Rgb& throughput, const Rgb& reflectance, double) const {
    const Rgb outgoing = throughput * reflectance;
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
  Rgb direct_light(const Vertex& v, Direct direct, Stream& random, Cost& cost) const {
    return world_.direct_light(v, direct, random, cost);
  }

 private:
  const World& world_;
  mutable int reflections_ = 0;
};

// Paths of which only the means are known.
std::shared_ptr<const Setup> broken_paths(const Scene& scene, const auto& path) {
  return setup_in_world(scene, knowledge(scene, {}), path);
}

std::shared_ptr<const Setup> paths_by(const Scene& scene, const auto& roulette, Direct direct) {
  return broken_paths(scene, [roulette, direct](const auto& world, auto&... run) {
    trace(world, roulette, direct, run...);
  });
}

// A path goes on from every albedo of `limit` or more: some surface must have a lower one.
void require_darker(const Parameters& parameters, const Scene& scene, double limit,
                    const char* why) {
  const auto dark = [&](const ZonedScene::Zone& zone) {
    return largest(zone.surface.albedo()) < limit;
  };
  if (scene.law && std::ranges::none_of(scene.law->zones, dark)) parameters.refuse("scene", why);
}

constexpr const char* classical = "paths/roulette";
constexpr const char* improved = "paths/improved_roulette";
constexpr const char* winners = "paths/winners";

// `make` makes a set-up from a scene and a sound plan.
template <class Make>
Entry entry(const Mutant& its, const Make& make) {
  const auto read_plan = its.original == classical ? read_classical : read_improved;
  return mutant(its, [read_plan, make](Parameters& parameters) {
    const Scene scene = paths::read_scene(parameters);
    const RoulettePlan plan = read_plan(parameters, scene);
    return make(scene, plan, parameters);
  });
}

template <class Broken>
Entry roulette_mutant(const Mutant& its) {
  return entry(its, [](const Scene& scene, const RoulettePlan& plan, Parameters&) {
    return paths_by(scene, Broken{plan.roulette(scene)}, plan.direct);
  });
}

// Replacements for how many children there are and what they weigh.

struct DrawnNumber : Winners {
  Rgb weight(const Rgb& reflectance, double, double drawn) const { return 1 / drawn * reflectance; }
};

struct AtLeastOneChild : Winners {
  // Below one half it stays a roulette, else no tree would end.
  double drawn(double expected, double u) const {
    return expected < 0.5 ? Winners::drawn(expected, u) : std::max(1.0, std::floor(expected));
  }
};

struct RoundedNumber : Winners {
  double drawn(double expected, double) const { return std::floor(expected + 0.5); }
};

struct CappedNumber : Winners {
  double drawn(double expected, double u) const {
    return Winners::drawn(std::min(expected, 2.0), u);
  }
};

struct SmallNumbersDropped : Winners {
  double drawn(double expected, double u) const {
    return expected < 0.1 ? 0 : Winners::drawn(expected, u);
  }
};

// Two defects need the children's values; they act at the first vertex, below it all is sound.

struct FirstVertex {
  double splitting;
  Direct direct;
  double bright;             ///< more than this is bright
  bool first_child_decides;  ///< that another follows; else the last one does

  void trace(const auto& world, Stream& random, Tally& tally, Cost& cost) const {
    const Winners sound(splitting);
    const Tree tree(world, sound, direct);
    const Vertex v = world.camera(cost);
    if (!v.surface) return;
    tally.count(0);
    tally.value += score(world, v, direct, true, random, cost);
    Tally children;
    double drawn = 0;
    bool another = false;
    do {
      const double before = sum(children.value);
      tree.grow({world.reflected(v, random, cost), v.surface->diffuse, 1, false}, random, children,
                cost);
      if (drawn == 0 || !first_child_decides) another = sum(children.value) - before > bright;
      drawn += 1;
    } while (another && drawn < splitting);
    tally.value += 1 / drawn * children.value;
    tally.vertices += children.vertices;
    for (std::size_t k = 0; k < Tally::bounces; ++k) tally.at_bounce[k] += children.at_bounce[k];
  }
};

// `path_of` makes a path from a scene, how light is learnt of and N. If a child follows from every
// n of a half or more (`rounds`), trees may never end.
template <class PathOf>
Entry of_winners(const Mutant& its, const PathOf& path_of, bool rounds = false) {
  return mutant(its, [path_of, rounds](Parameters& parameters) {
    const Scene scene = paths::read_scene(parameters);
    if (rounds) {
      require_darker(parameters, scene, 0.5,
                     "where every albedo is 1/2 or more, its trees never end");
    }
    const Direct direct = read_direct(parameters, scene);
    return broken_paths(scene, path_of(scene, direct, parameters.number("splitting")));
  });
}

template <class Broken>
Entry tree_mutant(const Mutant& its, bool rounds = false) {
  const auto path_of = [](const Scene&, Direct direct, double splitting) {
    return [broken = Broken{Winners(splitting)}, direct](const auto& world, auto&... run) {
      Tree(world, broken, direct).trace(run...);
    };
  };
  return of_winners(its, path_of, rounds);
}

Entry first_vertex_mutant(const Mutant& its, bool first_child_decides) {
  return of_winners(
      its, [first_child_decides](const Scene& scene, Direct direct, double splitting) {
        const FirstVertex first{splitting, direct, sum(scene.global.all) / 2, first_child_decides};
        return [first](const auto& world, auto&... run) { first.trace(world, run...); };
      });
}

}  // namespace

std::vector<Entry> mutants_paths() {
  return {
      roulette_mutant<TerminalNotSubtracted>(
          {"terminal_not_subtracted", improved,
           "adds the terminal value at the end and takes nothing off when going on; +50 "
           "% in a furnace of albedo 0.5."}),
      roulette_mutant<ThroughputNotDivided>({"throughput_not_divided", classical,
                                             "does not divide the throughput by the probability to "
                                             "go on; -33 % in a furnace of albedo 0.5."}),
      entry({"depth_limit", classical,
             "loses what comes after eight reflections; -0.2 % in a furnace of albedo 0.5, -13.4 % "
             "of albedo 0.8."},
            [](const Scene& scene, const RoulettePlan& plan, Parameters&) {
              return broken_paths(scene, [sound = plan.roulette(scene), direct = plan.direct](
                                             const auto& world, auto&... run) {
                trace(EightReflections(world), sound, direct, run...);
              });
            }),
      entry({"terminal_from_hindsight", improved,
             "raises the terminal value to what the path finds when it goes on; learns of light by "
             "hits whatever `direct` says. Nothing in a furnace, -10 % in the built-in sphere."},
            [](const Scene& scene, const RoulettePlan& plan, Parameters&) {
              return paths_by(scene, TerminalFromHindsight{plan.roulette(scene)}, Direct::hit);
            }),
      entry({"direct_light_twice", improved,
             "leaves the direct light in the terminal value although it is learnt of separately: "
             "still unbiased, but of a larger variance."},
            [](const Scene& scene, const RoulettePlan& plan, Parameters&) {
              // Twice counted: e as if light were learnt of by hits, however it is.
              const Incoming incoming = plan.incoming.value_or(scene.global);
              const Roulette broken(plan.rule, scene.global.all,
                                    global_terminal(scene, incoming, Direct::hit, plan.scale));
              return paths_by(scene, broken, plan.direct);
            }),
      roulette_mutant<DarkSurfacesEnd>(
          {"dark_surfaces_end", classical,
           "never goes on from surfaces whose albedo is below 0.3, and counts nothing "
           "for it; too dark where there are such surfaces."}),
      entry({"survival_above_one", classical,
             "goes on with 1.2 times the probability and divides by all of it, above 1, too; too "
             "dark where an albedo exceeds 5/6."},
            [](const Scene& scene, const RoulettePlan& plan, Parameters& parameters) {
              require_darker(parameters, scene, 0.8,
                             "where every albedo is 0.8 or more, its paths never end");
              return paths_by(scene, SurvivalAboveOne{plan.roulette(scene)}, plan.direct);
            }),
      roulette_mutant<DividedByItself>(
          {"divided_by_itself", classical,
           "divides each colour by its own albedo, so that the throughput stays what it "
           "was; saturated surfaces come out grey: +184 %, +950 % and +2060 % in the "
           "built-in coloured sphere."}),
      roulette_mutant<ClampedSurvival>(
          {"clamped_survival", classical,
           "goes on with probability 1/2 at least, and divides by what it was before; "
           "too bright where it was below: +67 %, +120 % and +139 % in the coloured "
           "sphere by the throughput."}),
      roulette_mutant<DarkPathsKilled>({"dark_paths_killed", classical,
                                        "ends paths whose probability to go on is below 0.1 "
                                        "without compensation; too dark where there are such."}),
      roulette_mutant<LuminanceThroughput>(
          {"luminance_throughput", classical,
           "keeps of the throughput its luminance alone; colours are lost: -58 %, +55 % "
           "and +219 % in the coloured sphere by the throughput."}),
      roulette_mutant<SurvivalAfterUpdate>(
          {"survival_after_update", classical,
           "decides by the throughput before the reflection and divides by the probability that "
           "follows from the one after it; -48 %, -53 % and -55 % in the coloured sphere by the "
           "throughput, nothing in grey scenes or by rules of the albedo alone."}),
      tree_mutant<DrawnNumber>(
          {"drawn_number", winners,
           "divides by the number of children that was drawn, not by the expected one: where none "
           "is drawn nothing makes up for it; -57 % in the built-in sphere."}),
      tree_mutant<AtLeastOneChild>({"at_least_one_child", winners,
                                    "has max(1, floor(n)) children of weight a / n where n is 1/2 "
                                    "or more; too bright where n is below 1, too dark above."},
                                   true),
      tree_mutant<RoundedNumber>({"rounded_number", winners,
                                  "rounds the number of children to the nearest, weight a / n."},
                                 true),
      first_vertex_mutant({"split_while_bright", winners,
                           "draws children of the first vertex until one is dark, and takes their "
                           "mean; -28 % in the built-in sphere."},
                          false),
      first_vertex_mutant({"number_from_first_child", winners,
                           "has one child of the first vertex, and if that is bright more, and "
                           "takes the mean of all; -31 % in the built-in sphere."},
                          true),
      tree_mutant<CappedNumber>({"capped_number", winners,
                                 "has two children at most, weighted as if there were no limit; "
                                 "-37.5 % in the built-in sphere, nothing where n is 2 or less."}),
      tree_mutant<SmallNumbersDropped>({"small_numbers_dropped", winners,
                                        "has no children where fewer than 0.1 are expected; too "
                                        "dark where albedos are that small, nothing elsewhere."}),
  };
}

}  // namespace assay::plugins
