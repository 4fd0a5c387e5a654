#pragma once

// Evidence about the law of a marginal. Its theta is the larger of two distances: of the
// distribution functions given a point (Kolmogorov and Smirnov), and of the probabilities of no
// point.

#include <cstdint>
#include <vector>

#include "harness/draws/draw_cells.h"
#include "harness/question/question.h"
#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "stats/laws/kolmogorov_smirnov.h"

namespace assay::harness {

/// A sample's points, sorted, and its number of draws.
struct Points {
  std::vector<double> sorted;
  std::uint64_t draws = 0;
  bool of_a_sampler = false;  ///< Only a sampler's draw may yield no point.

  std::uint64_t missing() const { return draws - sorted.size(); }
};

Points points_of(const Seen& seen, std::size_t subject);

/// The cells of a sampler's declared density, of a claim about its draws.
const DensityCells& density_of(const Question& question);

/// The law that points are held against. A table's distance to the law is at most `error`. So
/// "theta is at most" is tested with D - error, "theta is at least" with D + error.
struct DeclaredLaw {
  stats::ContinuousLaw law;
  double error = 0;
  double missing = 0;        ///< Probability of no point.
  double missing_error = 0;  ///< Its error.
};

/// The law that a claim about one sample names, or the sampler's density.
DeclaredLaw declared_law(const Question& question, std::size_t channel);

/// If no mass is declared missing and the sample misses none, the points have the whole level.
/// Under the null hypothesis missing mass then has probability 0 (up to the error). Else points and
/// mass have half the level each (Bonferroni).
Evidence points_against_law(const Points& points, const DeclaredLaw& declared);

/// "One law" is tested given the pooled values (stats/laws/kolmogorov_smirnov.h), "at most theta"
/// by a bound on the distance. Two samplers always share the level: missing mass is not known
/// beforehand.
Evidence points_against_points(const Points& x, const Points& y);

// Evidence about laws from counts in cells. theta = w, Cohen's effect size over the cells.

/// Counts of one side's values in each cell. The last number counts draws without a point.
std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Seen& seen,
                                     std::size_t subject);

}  // namespace assay::harness
