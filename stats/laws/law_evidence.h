#pragma once

#include <cstdint>
#include <vector>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// Evidence about laws of numbers of which some draws have none. Theta is the larger of two
// distances: of the distribution functions given a point (Kolmogorov and Smirnov), and of the
// probabilities of no point.

// A sample's points, sorted, and its number of draws.
struct Points {
  std::vector<double> sorted;
  std::uint64_t draws = 0;
  bool of_a_sampler = false;  // Only a sampler's draw may yield no point.

  std::uint64_t missing() const { return draws - sorted.size(); }
};

// The law that points are held against. A table's distance to the law is at most `error`. So
// "theta is at most" is tested with D - error, "theta is at least" with D + error.
struct DeclaredLaw {
  ContinuousLaw law;
  double error = 0;
  double missing = 0;        // Probability of no point.
  double missing_error = 0;  // Its error.
};

// If no mass is declared missing and the sample misses none, the points have the whole level.
// Under the null hypothesis missing mass then has probability 0 (up to the error). Else points and
// mass have half the level each (Bonferroni). Throws std::domain_error without points.
Evidence points_against_law(const Points& points, const DeclaredLaw& declared);

// "One law" is tested given the pooled values (two_part_ks), "at most theta" by a bound on the
// distance. Two samplers always share the level: missing mass is not known beforehand. Throws
// std::domain_error if a side has no points.
Evidence points_against_points(const Points& x, const Points& y);

}  // namespace assay::stats
