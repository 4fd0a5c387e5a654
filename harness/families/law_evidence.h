#pragma once

// Evidence about the law of a marginal: the points by Kolmogorov and Smirnov, and the mass that
// yields no point by its proportion. theta is the larger of the two distances: that of the
// distribution functions given a point, and that of the probabilities of no point.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "stats/laws/kolmogorov_smirnov.h"

namespace assay::harness {

/// A sample as its points, sorted, and the number of draws.
struct Points {
  std::vector<double> sorted;
  std::uint64_t draws = 0;
  bool of_a_sampler = false;  ///< only a sampler's draw may yield no point

  std::uint64_t missing() const { return draws - sorted.size(); }
};

/// The value of a subject's first channel that stands for a draw without a point; only samplers
/// have one.
std::optional<double> no_point_of(const Subject& side);

Points points_of(const Question& question, std::size_t subject, std::size_t channel,
                 std::span<const double> values);

/// What a sample of points is held against. The law may be a table: its distance to the declared
/// law is at most `error`, so that the true distance lies within `error` of the measured one. The
/// p-value against "theta is at most" takes D - error, that against "theta is at least" D + error.
struct DeclaredLaw {
  stats::ContinuousLaw law;
  double error = 0;
  double missing = 0;        ///< probability of no point
  double missing_error = 0;  ///< of it
};

/// What a claim about one sample holds it against: the law it names, or the sampler's density.
DeclaredLaw declared_law(const Question& question, std::size_t channel);

/// Which test of "the law is the declared one" the points get. Anderson and Darling's has the
/// tails' weight and knows no margin: of theta above 0, and of intervals, it leaves to Kolmogorov
/// and Smirnov's distance, valid for every law.
enum class PointsTest { kolmogorov_smirnov, anderson_darling };

/// Where mass is declared missing the two parts share the level, each half (Bonferroni). Where none
/// is and the sample misses none there is nothing to test and the points have it whole: under the
/// null hypothesis the other case has probability 0 (up to the error).
Evidence points_against_law(const Points& points, const DeclaredLaw& declared,
                            PointsTest test = PointsTest::kolmogorov_smirnov);

/// Two samplers share the level always: whether mass is missing is not known beforehand.
Evidence points_against_points(const Points& x, const Points& y);

/// Values of one law that may have an atom: whether it is as probable in both (Fisher's exact test,
/// 1935), and whether the other values follow one law; the parts share the level. theta is the
/// larger of the two differences. A sample that is all atom says nothing of the rest.
Evidence points_split_at(double atom, const Points& x, const Points& y);

}  // namespace assay::harness
