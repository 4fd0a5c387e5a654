#pragma once

// Go with the winners: a fractional number of children at each vertex.

#include <cmath>

#include "paths/path.h"

namespace assay::paths {

/// The number of a vertex's children, and the weight of each. The anticipated error of a diffuse
/// reflection is `splitting` times that of a mirror: n = W a N, or n = W a. W is the mean over the
/// colours of the weight so far. The source is Szirmay-Kalos, Antal and Sbert (2005), with n = W a
/// sqrt(1 + (N^2 - 1) / (shininess + 1)^2).
class Winners {
 public:
  explicit Winners(double splitting) : splitting_(splitting) {}

  /// The expected number of children, fixed before any of them is seen.
  double diffuse_children(const Spectrum& weight, const Surface& surface) const {
    return mean(weight * surface.diffuse) * splitting_;
  }
  double mirror_children(const Spectrum& weight, const Surface& surface) const {
    return mean(weight * surface.mirror);
  }
  /// floor(n + u): n children on average.
  double drawn(double expected, double u) const { return std::floor(expected + u); }
  /// The reflectance is divided by the expected number, not by the drawn one.
  Spectrum weight(const Spectrum& reflectance, double expected, double /*drawn*/) const {
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
    Spectrum weight;
    std::size_t bounce;
    bool sees_emission;
  };

  void trace(Stream& random, Tally& tally, Cost& cost) const {
    grow({world_.camera(cost), Spectrum::grey(1), 0, true}, random, tally, cost);
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
      const Spectrum weight = node.weight * rule_.weight(surface.diffuse, diffuse, drawn);
      for (double i = 0; i < drawn; ++i) {
        grow({world_.reflected(v, random, cost), weight, node.bounce + 1, false}, random, tally,
             cost);
      }
    }
    if (surface.mirror == Spectrum{}) return;
    const double mirror = rule_.mirror_children(node.weight, surface);
    // Weights are at most 1 on average over the colours, so there is one reflection or none.
    const double reflections = rule_.drawn(mirror, random.uniform());
    if (reflections > 0) {
      const Spectrum weight = node.weight * rule_.weight(surface.mirror, mirror, reflections);
      grow({world_.mirrored(v, cost), weight, node.bounce + 1, true}, random, tally, cost);
    }
  }

  const World& world_;
  const Rule& rule_;
  Direct direct_;
};

}  // namespace assay::paths
