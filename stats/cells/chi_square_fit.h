#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/cells/cell_effect.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Observed counts and the null law's probability of every cell, the same length. Probabilities sum
// to 1: mass that yields no point is a cell of its own, given by the caller. `error`: how far each
// probability may be off, of the same length; empty: they are exact.
struct CellCounts {
  std::vector<std::uint64_t> observed;
  std::vector<double> probability;
  std::vector<double> error = {};
};

struct FitOptions {
  // Cells are pooled up to this expected count. 20 keeps the level at 1e-4 within 1.1 (statistics
  // of 50 cells; at 5 it is 1.9, at 1 it is 3.4).
  double minimum_expected = 20;
  // Bound on the total probability that quadrature may have missed in cells whose probability is 0,
  // and on the error of the sum of all probabilities.
  double probability_tolerance = 1e-9;
};

struct ChiSquareFit {
  TestResult test;  // log_p_upper is the p-value of "the law is the null law"
  double degrees_of_freedom = 0;
  std::vector<PooledCell> cells;
  std::uint64_t observations = 0;
  // Observations in cells of probability zero. They reject at once: log_p_upper is then ln 2 plus
  // the smaller of the chi-square tail and ln P(Binomial(n, probability_tolerance) >= impossible),
  // and with a zero tolerance the most negative finite double.
  std::uint64_t impossible = 0;
  double probability_tolerance = 0;  // as given
  // w that errors of the probabilities may amount to: r = sqrt(sum e^2 / p0) over the pooled cells,
  // of which e is the sum of their members' errors.
  double error_effect = 0;
  // Estimate of w below: sqrt(max(0, U)) by CellEffect (cell_effect.h), with impossible
  // observations sqrt(max(0, U) + max(0, m - t)^2 / t), m their share, t the tolerance.
  double effect = 0;
};

// Null hypothesis: the counts are multinomial with these probabilities. Pearson's X2 = sum
// (O-E)^2/E, chi-square with nu = pools - 1. Pooling looks at the expected counts only: cells of at
// least minimum_expected stand alone, the others are gathered in index order, and an incomplete
// last pool joins the previous pool (or, lacking one, the least expected cell that stands alone).
// Throws std::domain_error: lengths differ, no observation, negative or non-finite probabilities,
// sum off 1 by more than the tolerance (plus rounding), fewer than two pools. Where r > 0 the null
// hypothesis is w <= r (below), and log_p_upper the larger p-value of the two.
ChiSquareFit chi_square_fit(const CellCounts& counts, FitOptions options = {});

// Effect size over the pooled cells, w = sqrt(sum (p1 - p0)^2 / p0) (Cohen 1988), tested by its
// unbiased estimate (cell_effect.h): log_p_upper rejects "w <= null_effect", log_p_lower rejects
// "w >= null_effect". Cells of probability zero are one of probability t, the tolerance: that
// w <= w0 means a share of at most t + w0 sqrt(t) of observations in them (binomial, where there
// are any). To reject "w <= w0" either way is enough, at half the level; to reject "w >= w0" takes
// both. Probabilities with errors reject "w <= w0" where they reject w <= w0 + r, and "w >= w0"
// where they reject w >= w0 - r: to first order in e / p0 the triangle inequality. Statistic:
// CellEffect::statistic. Asymptotic. Throws std::domain_error below 4
// observations.
TestResult chi_square_fit_effect(const ChiSquareFit& fit, double null_effect);

// Central interval of w: effect_interval() of chi_square_effect.h, both ends NaN where no w is
// left.
Interval chi_square_fit_interval(const ChiSquareFit& fit, double confidence);

}  // namespace assay::stats
