#pragma once

// Entries of suites whose effects have closed forms, for claims at the edge of a margin.

#include <fmt/format.h>

#include "harness/draws/sampler_setup.h"
#include "stats/cells/chi_square.h"
#include "tests/harness/questions.h"
#include "tests/harness/table.h"

namespace assay::harness {

/// The estimators of tests/tables/levels.txt that tests name: what is not drawn costs nothing.
inline std::string estimators_of(const std::string& tests) {
  std::string text = "estimators:\n";
  for (const std::string& entry : lines(sections_of("levels.txt").at(0).head)) {
    const std::string name = entry.substr(2, entry.find(':') - 2);
    if (std::regex_search(tests, std::regex("(\\(|reference: )" + name + "\\b")))
      text += entry + "\n";
  }
  return text;
}

/// A suite of these claims, with what a test says beside; their names are 0, 1, ….
inline std::string suite_of(const std::vector<std::string>& claims, double alpha, double beta) {
  std::string tests;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    tests += fmt::format("  - {{name: '{}', claim: {}}}\n", i, claims[i]);
  }
  return fmt::format("suite: effects\nalpha: {}\nbeta: {}\n{}tests:\n{}", alpha, beta,
                     estimators_of(tests), tests);
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

/// The claim with the triangle's effect, as for its secondaries, in place of EFFECT.
inline std::string with_effect(std::string claim) {
  const std::size_t at = claim.find("EFFECT");
  if (at == claim.npos) return claim;
  const std::uint64_t draws = std::stoul(claim.substr(claim.find("secondaries: ") + 13));
  return claim.replace(at, 6, fmt::format("{:.17g}", effect_of_triangle(draws)));
}

}  // namespace assay::harness
