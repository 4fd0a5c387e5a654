// Mutants of go with the winners: the sound parts with one replaced.

#include "paths/winners.h"

#include <algorithm>

#include "estimators/mutant.h"
#include "paths/family.h"

namespace assay::plugins {

namespace {

using namespace paths;

// Replacements for how many children there are and what they weigh.

struct DrawnNumber : Winners {
  Spectrum weight(const Spectrum& reflectance, double, double drawn) const {
    return 1 / drawn * reflectance;
  }
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

// True if another child follows after `drawn` ones, of which the first and the last were bright or
// not.
struct WhileBright {
  bool operator()(bool /*first_bright*/, bool last_bright, double drawn, double splitting) const {
    return last_bright && drawn < splitting;
  }
};

struct AsTheFirstChildSays {
  bool operator()(bool first_bright, bool /*last_bright*/, double drawn, double splitting) const {
    return first_bright && drawn < splitting;
  }
};

struct FirstVertex {
  double splitting;
  Direct direct;
  double bright;  ///< more than this is bright

  template <class World, class Another>
  void trace(const World& world, const Another& another, Stream& random, Tally& tally,
             Cost& cost) const {
    const Winners sound(splitting);
    const Tree<World, Winners> tree(world, sound, direct);
    const Vertex v = world.camera(cost);
    if (!v.surface) return;
    tally.count(0);
    tally.value += score(world, v, direct, true, random, cost);
    Tally children;
    double drawn = 0;
    bool first = false;
    bool last = false;
    do {
      const double before = sum(children.value);
      tree.grow({world.reflected(v, random, cost), v.surface->diffuse, 1, false}, random, children,
                cost);
      last = sum(children.value) - before > bright;
      if (drawn == 0) first = last;
      drawn += 1;
    } while (another(first, last, drawn, splitting));
    tally.value += 1 / drawn * children.value;
    tally.vertices += children.vertices;
    for (std::size_t k = 0; k < Tally::bounces; ++k) tally.at_bounce[k] += children.at_bounce[k];
  }
};

// Entries.

Entry of_winners(const char* name, const char* defect,
                 std::function<std::shared_ptr<const Setup>(Parameters&)> prepare) {
  return mutant({name, "paths/winners", defect}, std::move(prepare));
}

template <class Broken>
Entry tree_mutant(const char* name, const char* defect) {
  return of_winners(name, defect, [](Parameters& parameters) {
    const Scene scene = paths::read_scene(parameters);
    const Direct direct = read_direct(parameters, scene);
    const Broken broken{Winners(parameters.number("splitting"))};
    return with_world(scene, [&](const auto& world) {
      return mutant_setup(scene, [world, broken, direct](Stream& random, Tally& tally, Cost& cost) {
        Tree(*world, broken, direct).trace(random, tally, cost);
      });
    });
  });
}

template <class Another>
Entry first_vertex_mutant(const char* name, const char* defect) {
  return of_winners(name, defect, [](Parameters& parameters) {
    const Scene scene = paths::read_scene(parameters);
    const Direct direct = read_direct(parameters, scene);
    const FirstVertex first{parameters.number("splitting"), direct, sum(scene.global.all) / 2};
    return with_world(scene, [&](const auto& world) {
      return mutant_setup(scene, [world, first](Stream& random, Tally& tally, Cost& cost) {
        first.trace(*world, Another{}, random, tally, cost);
      });
    });
  });
}

// If a child follows from every n of a half or more, some surface must have fewer.
template <class Broken>
Entry rounding_mutant(const char* name, const char* defect) {
  Entry entry = tree_mutant<Broken>(name, defect);
  entry.prepare = [prepare = entry.prepare](Parameters& parameters) {
    const Scene scene = paths::read_scene(parameters);
    bool ends = !scene.law;
    if (scene.law) {
      for (const ZonedScene::Zone& zone : scene.law->zones) {
        ends = ends || largest(zone.surface.albedo()) < 0.5;
      }
    }
    if (!ends) parameters.refuse("scene", "where every albedo is 1/2 or more, its trees never end");
    return prepare(parameters);
  };
  return entry;
}

}  // namespace

std::vector<Entry> mutants_winners() {
  return {
      tree_mutant<DrawnNumber>(
          "drawn_number",
          "divides by the number of children that was drawn, not by the expected one: where none "
          "is drawn nothing makes up for it; -57 % in the built-in sphere."),
      rounding_mutant<AtLeastOneChild>(
          "at_least_one_child",
          "has max(1, floor(n)) children of weight a / n where n is 1/2 or more; too bright where "
          "n is below 1, too dark above."),
      rounding_mutant<RoundedNumber>("rounded_number",
                                     "rounds the number of children to the nearest, weight a / n."),
      first_vertex_mutant<WhileBright>("split_while_bright",
                                       "draws children of the first vertex until one is dark, and "
                                       "takes their mean; -28 % in the built-in sphere."),
      first_vertex_mutant<AsTheFirstChildSays>(
          "number_from_first_child",
          "has one child of the first vertex, and if that is bright more, and takes the mean of "
          "all; -31 % in the built-in sphere."),
      tree_mutant<CappedNumber>("capped_number",
                                "has two children at most, weighted as if there were no limit; "
                                "-37.5 % in the built-in sphere, nothing where n is 2 or less."),
      tree_mutant<SmallNumbersDropped>("small_numbers_dropped",
                                       "has no children where fewer than 0.1 are expected; too "
                                       "dark where albedos are that small, nothing elsewhere."),
  };
}

}  // namespace assay::plugins
