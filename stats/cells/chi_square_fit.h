#pragma once

#include <cstdint>
#include <vector>

#include "stats/cells/cell_effect.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// Observed counts, and the null law's probability of every cell. Probabilities sum to 1, so mass
// that yields no point is a cell of its own. The bounds `error` on their errors are empty if they
// are exact. All three have one length.
struct CellCounts {
  std::vector<std::uint64_t> observed;
  std::vector<double> probability;
  std::vector<double> error = {};
};

struct FitOptions {
  // Cells are pooled up to this expected count. At 20 the level 1e-4 holds within a factor 1.1.
  double minimum_expected = 20;
  // Bound on the mass that quadrature may have missed in cells of probability 0. It also bounds the
  // error of the sum of all probabilities.
  double probability_tolerance = 1e-9;
};

struct ChiSquareFit {
  TestResult test;  // log_p_upper is the p-value of "the law is the null law".
  double degrees_of_freedom = 0;
  std::vector<PooledCell> cells;
  std::uint64_t observations = 0;
  // Observations in cells of probability zero. They reject at once. log_p_upper is then ln 2 plus
  // the smaller of two: the chi-square tail, and ln P(Binomial(n, probability_tolerance) >=
  // impossible). With a zero tolerance it is the most negative finite double.
  std::uint64_t impossible = 0;
  double probability_tolerance = 0;
  // The w that errors of the probabilities may amount to. It is r = sqrt(sum e^2 / p0) over the
  // pooled cells, e the sum of their members' errors.
  double error_effect = 0;
  // Estimate of w below: sqrt(max(0, U)) by CellEffect (cell_effect.h). With impossible
  // observations it is sqrt(max(0, U) + max(0, m - t)^2 / t), m their share and t the tolerance.
  double effect = 0;
};

// Null hypothesis: the counts are multinomial with these probabilities. If r > 0 it is w <= r
// instead (below), and log_p_upper is the larger p-value of the two. Pearson's X2 = sum (O-E)^2/E,
// chi-square with nu = pools - 1. Pooling looks at the expected counts only. Cells of at least
// minimum_expected stand alone, and the others are gathered in index order. An incomplete last pool
// joins the previous pool, or the least expected single cell if there is none. Throws
// std::domain_error: lengths differ, no observation, negative or non-finite probabilities, sum off
// 1 by more than the tolerance plus rounding, fewer than two pools.
ChiSquareFit chi_square_fit(const CellCounts& counts, FitOptions options = {});

// Effect size over the pooled cells, w = sqrt(sum (p1 - p0)^2 / p0) (Cohen 1988). It is tested by
// its unbiased estimate (cell_effect.h). log_p_upper rejects "w <= null_effect", log_p_lower
// rejects "w >= null_effect". Cells of probability zero count as one of probability t, the
// tolerance. There w <= w0 means a share of at most t + w0 sqrt(t) of the observations (binomial,
// if there are any). Either test at half the level rejects "w <= w0". Both are needed to reject "w
// >= w0". With errors, "w <= w0" is tested at w0 + r and "w >= w0" at w0 - r. To first order in e /
// p0 that is the triangle inequality. Statistic: CellEffect::statistic. Asymptotic. Throws
// std::domain_error below 4 observations.
TestResult chi_square_fit_effect(const ChiSquareFit& fit, double null_effect);

// Central interval of w by effect_interval(). Both ends are NaN if no w is
// left.
Interval chi_square_fit_interval(const ChiSquareFit& fit, double confidence);

// Evidence about w; about w = 0 by chi_square_fit's own test.
Evidence chi_square_evidence(const ChiSquareFit& fit);

}  // namespace assay::stats
