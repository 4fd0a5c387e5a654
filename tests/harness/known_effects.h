#pragma once

// Entries of suites whose effects have closed forms, for claims at the edge of a margin.

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/draws/sampler_setup.h"
#include "stats/cells/chi_square_fit.h"
#include "tests/harness/questions.h"

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

/// The effect w of the triangle's draws over its cells, pooled as for so many draws. Counts of many
/// more draws tell it to a thousandth.
inline double effect_of_triangle(std::uint64_t draws) {
  const auto setup = setup_of("{plugin: mutants/nonuniform_triangle}", "point");
  const DensityCells& declared = setup->density_cells();
  stats::CellCounts counts{.observed = std::vector<std::uint64_t>(declared.cells.size()),
                           .probability = declared.mass.probability};
  counts.probability.push_back(declared.missing());
  constexpr std::uint64_t many = 2'000'000;
  constexpr std::uint64_t batch = 1000;
  for (std::uint64_t first = 0; first < many; first += batch) {
    std::vector<Stream> streams;
    for (std::uint64_t i = first; i < first + batch; ++i) streams.emplace_back(StreamKey{77}, i);
    for (const SamplerDraw& draw : draws_of(setup->sampler(), streams)) {
      ++counts.observed[declared.cells.index(draw)];
    }
  }
  const double scale = static_cast<double>(many) / static_cast<double>(draws);
  return stats::chi_square_fit(counts, {.minimum_expected = 20 * scale,
                                        .probability_tolerance = declared.tolerance()})
      .effect;
}

/// w of three in ten against a half, over 0 and 1: sqrt(sum (p - q)^2 / ((p + q) / 2)).
inline double effect_of_halves() { return std::sqrt(0.04 / 0.4 + 0.04 / 0.6); }

}  // namespace assay::harness
