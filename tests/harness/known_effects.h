#pragma once

// Entries of suites whose effects have closed forms, for claims at the edge of a margin.

#include <cmath>
#include <map>
#include <string>

namespace assay::harness {

/// Paths that are absorbed with probability .4 at every bounce: their rays are as random as their
/// values. So many in a secondary that methods whose data must be near normal are valid of
/// hundreds.
inline const std::string absorbed_path =
    "plugin: paths/roulette, scene: {zones: [{top: 1, emission: 1, albedo: 0.6}], "
    "camera: {position: [0, 0, 0], direction: [1, 0, 0]}}, primaries: 4";

inline const std::map<std::string, std::string> known_effects{
    {"path", absorbed_path},
    {"path_again", absorbed_path},
    {"three_in_ten", "plugin: analytic/law, law: bernoulli(0.3), primaries: 1"},
    {"half", "plugin: analytic/law, law: bernoulli(0.5), primaries: 1"},
    {"triangle", "plugin: mutants/nonuniform_triangle"},
};

inline std::map<std::string, std::string> with_known_effects(
    std::map<std::string, std::string> entries) {
  entries.insert(known_effects.begin(), known_effects.end());
  return entries;
}

/// The effect w of the triangle's draws over its cells. Draws of u and v / (1 - u) are uniform.
/// The declared density, 2, has P(u <= x) = 1 - (1 - x)^2. The grid has 16 rows of equal area.
inline double effect_of_triangle() {
  double w2 = 0;
  for (int row = 0; row < 16; ++row) {
    const double drawn = std::sqrt(1 - row / 16.0) - std::sqrt(1 - (row + 1) / 16.0);
    w2 += 16 * (drawn - 1 / 16.0) * (drawn - 1 / 16.0);
  }
  return std::sqrt(w2);
}

/// w of three in ten against a half, over 0 and 1: sqrt(sum (p - q)^2 / ((p + q) / 2)).
inline double effect_of_halves() { return std::sqrt(0.04 / 0.4 + 0.04 / 0.6); }

}  // namespace assay::harness
