#pragma once

// Paths whatever the world: with roulette, plain, and trees. Mutants replace the template
// parameters.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "estimators/cost.h"
#include "estimators/stream.h"
#include "paths/surface.h"

namespace assay::paths {

/// The probability to go on, from the throughput T and the albedo a of each colour. Each is a
/// weighted mean of the albedo, or its maximum, and so below 1.
enum class Rule {
  max_albedo,   ///< Value max a.
  mean_albedo,  ///< Value (sum a) / 3.
  luminance,    ///< Luminance of a.
  throughput,   ///< Value sum T a / sum T: keeps the sum of T as it is.
  radiance,     ///< Value sum T a L / sum T L, L the scene's mean radiance: keeps the sum of T L.
};

/// Probabilities to go on by a diffuse reflection and by the mirror.
struct Survival {
  double diffuse = 0;
  double mirror = 0;

  double total() const { return diffuse + mirror; }
};

/// Russian roulette with terminal values (Szecsi, Szirmay-Kalos and Kelemen 2003). T is a vertex's
/// throughput, a its albedo, s the probability to go on and e the terminal value. A path that ends
/// adds T e. One that goes on subtracts T e (1 - s) / s and multiplies T by a / s. The expectation
/// is the same for every e. With e = 0 it is the classical roulette.
class Roulette {
 public:
  /// `terminal` holds e of each patch, or nothing for e = 0.
  Roulette(Rule rule, const Rgb& mean_radiance, std::vector<Rgb> terminal)
      : rule_(rule), mean_radiance_(mean_radiance), terminal_(std::move(terminal)) {}

  double rule(const Rgb& throughput, const Rgb& albedo) const {
    switch (rule_) {
      case Rule::max_albedo:
        return largest(albedo);
      case Rule::mean_albedo:
        return mean(albedo);
      case Rule::luminance:
        return luminance(albedo);
      case Rule::throughput:
        return sum(throughput * albedo) / sum(throughput);
      case Rule::radiance:
        break;
    }
    const Rgb weight = throughput * mean_radiance_;
    // Nothing is lost if no light can arrive in any channel that the path still carries.
    return sum(weight) > 0 ? sum(weight * albedo) / sum(weight) : 0;
  }

  /// The rule's value for the whole albedo, split between the lobes by the rule's value for each.
  Survival survival(const Rgb& throughput, const Surface& surface) const {
    const double total = rule(throughput, surface.albedo());
    if (surface.mirror == Rgb{} || total == 0) return {.diffuse = total};
    const double diffuse = rule(throughput, surface.diffuse);
    const double mirror = rule(throughput, surface.mirror);
    return {total * diffuse / (diffuse + mirror), total * mirror / (diffuse + mirror)};
  }

  Rgb terminal(const Vertex& v) const { return terminal_.empty() ? Rgb{} : terminal_[v.patch]; }
  /// A path that goes on `from` a surface to the next vertex adds this.
  Rgb on_going_on(const Rgb& terminal, double survival, const Surface& /*from*/,
                  const Vertex& /*next*/) const {
    return (survival - 1) / survival * terminal;
  }
  /// The throughput after a reflection that was chosen with this probability.
  Rgb continued(const Rgb& throughput, const Rgb& reflectance, double probability) const {
    return 1 / probability * (throughput * reflectance);
  }

 private:
  Rule rule_;
  Rgb mean_radiance_;
  std::vector<Rgb> terminal_;
};

/// The light of a path, and its number of vertices at each bounce. Bounce 0 is what the camera
/// sees.
struct Tally {
  static constexpr std::size_t bounces = 7;

  Rgb value;
  std::uint64_t vertices = 0;
  std::array<std::uint64_t, bounces> at_bounce{};

  void count(std::size_t bounce) {
    ++vertices;
    if (bounce < bounces) ++at_bounce[bounce];
  }
};

/// The score of a vertex by itself. Emission counts if the path arrived by the camera's ray or a
/// mirror. Elsewhere it counts only if light is found by hits.
template <class World>
Rgb score(const World& world, const Vertex& v, Direct direct, bool sees_emission, Stream& random,
          Cost& cost) {
  const Rgb emission = sees_emission || direct == Direct::hit ? v.surface->emission : Rgb{};
  if (direct == Direct::hit || v.surface->diffuse == Rgb{}) return emission;
  return emission + world.direct_light(v, direct, random, cost);
}

/// A path with roulette at every vertex; `World` and `Roulette` are templates so that a mutant
/// can replace a part of either.
template <class World, class Roulette>
void trace(const World& world, const Roulette& roulette, Direct direct, Stream& random,
           Tally& tally, Cost& cost) {
  Rgb throughput = Rgb::grey(1);
  bool sees_emission = true;
  Vertex v = world.camera(cost);
  for (std::size_t bounce = 0; v.surface; ++bounce) {
    tally.count(bounce);
    tally.value += throughput * score(world, v, direct, sees_emission, random, cost);
    const Surface& surface = *v.surface;
    const Survival s = roulette.survival(throughput, surface);
    const Rgb terminal = roulette.terminal(v);
    const double u = random.uniform();
    if (u >= s.total()) {
      tally.value += throughput * terminal;
      return;
    }
    const bool mirror = u >= s.diffuse;
    sees_emission = mirror;
    v = mirror ? world.mirrored(v, cost) : world.reflected(v, random, cost);
    tally.value += throughput * roulette.on_going_on(terminal, s.total(), surface, v);
    throughput = mirror ? roulette.continued(throughput, surface.mirror, s.mirror)
                        : roulette.continued(throughput, surface.diffuse, s.diffuse);
  }
}

/// Adds the light of a path from `v` on to the tally. It is the sum of T_k Le_k, with T_0 = 1 and
/// T_k+1 = T_k a_k / survival. The type `Random` gives uniform numbers in [0, 1). It is a stream,
/// or coordinates that a Markov chain has mutated. A vertex takes one number to decide to go on,
/// one more at a mirror, and two for a diffuse direction.
template <class World, class Random>
void walk(const World& world, Vertex v, double survival, Random& random, Tally& tally, Cost& cost) {
  Rgb throughput = Rgb::grey(1);
  for (std::size_t bounce = 0; v.surface; ++bounce) {
    tally.count(bounce);
    tally.value += throughput * v.surface->emission;
    if (random.uniform() >= survival) return;
    const bool mirrors = !(v.surface->mirror == Rgb{});
    if (mirrors && random.uniform() < 0.5) {
      throughput = 2 / survival * (throughput * v.surface->mirror);
      v = world.mirrored(v, cost);
    } else {
      throughput = (mirrors ? 2 : 1) / survival * (throughput * v.surface->diffuse);
      v = world.reflected(v, random, cost);
    }
  }
}

/// The number of a vertex's children, and the weight of each. The anticipated error of a diffuse
/// reflection is `splitting` times that of a mirror: n = W a N, or n = W a. W is the mean over the
/// colours of the weight so far. The source is Szirmay-Kalos, Antal and Sbert (2005), with n = W a
/// sqrt(1 + (N^2 - 1) / (shininess + 1)^2).
class Winners {
 public:
  explicit Winners(double splitting) : splitting_(splitting) {}

  /// The expected number of children, fixed before any of them is seen.
  double diffuse_children(const Rgb& weight, const Surface& surface) const {
    return mean(weight * surface.diffuse) * splitting_;
  }
  double mirror_children(const Rgb& weight, const Surface& surface) const {
    return mean(weight * surface.mirror);
  }
  /// floor(n + u): n children on average.
  double drawn(double expected, double u) const { return std::floor(expected + u); }
  /// The reflectance is divided by the expected number, not by the drawn one.
  Rgb weight(const Rgb& reflectance, double expected, double /*drawn*/) const {
    return 1 / expected * reflectance;
  }

 private:
  double splitting_;
};

/// A tree of paths. The children of a vertex are independent of one another.
template <class World, class Rule>
class Tree {
 public:
  Tree(const World& world, const Rule& rule, Direct direct)
      : world_(world), rule_(rule), direct_(direct) {}

  struct Node {
    Vertex vertex;
    Rgb weight;
    std::size_t bounce;
    bool sees_emission;
  };

  void trace(Stream& random, Tally& tally, Cost& cost) const {
    grow({world_.camera(cost), Rgb::grey(1), 0, true}, random, tally, cost);
  }

  /// Adds what a vertex scores and all that grows from it.
  void grow(const Node& node, Stream& random, Tally& tally, Cost& cost) const {
    const Vertex& v = node.vertex;
    if (!v.surface) return;
    tally.count(node.bounce);
    tally.value += node.weight * score(world_, v, direct_, node.sees_emission, random, cost);
    const Surface& surface = *v.surface;
    const double diffuse = rule_.diffuse_children(node.weight, surface);
    const double drawn = rule_.drawn(diffuse, random.uniform());
    if (drawn > 0) {
      const Rgb weight = node.weight * rule_.weight(surface.diffuse, diffuse, drawn);
      for (double i = 0; i < drawn; ++i) {
        grow({world_.reflected(v, random, cost), weight, node.bounce + 1, false}, random, tally,
             cost);
      }
    }
    if (surface.mirror == Rgb{}) return;
    const double mirror = rule_.mirror_children(node.weight, surface);
    // Weights are at most 1 on average over the colours, so there is one reflection or none.
    const double reflections = rule_.drawn(mirror, random.uniform());
    if (reflections > 0) {
      const Rgb weight = node.weight * rule_.weight(surface.mirror, mirror, reflections);
      grow({world_.mirrored(v, cost), weight, node.bounce + 1, true}, random, tally, cost);
    }
  }

  const World& world_;
  const Rule& rule_;
  Direct direct_;
};

}  // namespace assay::paths
