#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/tails/evidence.h"
#include "stats/tails/tails.h"

namespace assay::stats {

struct PooledCell {
  std::uint64_t observed = 0;
  double expected = 0;               // n p0.
  std::vector<std::size_t> members;  // Indices of the caller's cells.
};

// The distance of a law p1 from the null law p0. Counts O of n >= 4 multinomial observations
// estimate it, with p0 > 0 (Cohen 1988). The p0 sum to 1.
//   w^2 = sum (p1 - p0)^2 / p0 = E_0 d^2,  d = p1 / p0 - 1.
// Falling factorials O (O-1) ... / n (n-1) ... estimate sums over d without bias.
class CellEffect {
 public:
  static constexpr std::uint64_t fewest_observations = 4;

  // Throws std::domain_error where n is less.
  CellEffect(std::span<const PooledCell> cells, std::uint64_t observations);

  // The unbiased estimate U = sum O (O-1) / (n (n-1) p0) - 1 of w^2, which may be negative.
  double squared() const { return squared_; }

  // Tails of U if w were null_effect. The upper tail is small where w is larger, the lower where it
  // is smaller. The variance of U is (Hoeffding 1948)
  //   4 (n-2)/(n (n-1)) z1 + 2/(n (n-1)) z2.
  // Here z1 = w^2 + E_0 d^3 - w^4, the variance of p1/p0 under p1.
  // And z2 = sum (p1/p0)^2 - (1 + w^2)^2.
  // In it d is the data's, scaled to the null effect by at most 2. Neither part is below that of
  // noncentral chi-square, w^2 and K - 1. So a cell that carries the effect enlarges the variance.
  // The law of U is taken for noncentral chi-square of K - 1 degrees and n w^2, moved to this mean
  // and variance. For the upper tail both parameters are divided so that the skewness matches the
  // data's excess. That excess is n (56 E_0 d^3 + 32 E_0 d^4) in the third cumulant of n U.
  // Asymptotic; see measurements.md.
  LogTails tails(double null_effect) const;

  // n U moved to the mean and variance of noncentral chi-square of K - 1 degrees and n
  // null_effect^2. Its lower tail there is that of tails(). Its upper tail is less skew.
  double statistic(double null_effect) const;

 private:
  struct AtNull;
  AtNull at_null(double null_effect) const;
  double moved(const AtNull& law, double null_effect, Noncentral to) const;

  double n_;
  double cells_;
  double squared_ = 0;
  double third_ = 0;        // E_0 d^3.
  double fourth_ = 0;       // E_0 d^4.
  double sum_ = 0;          // Sum of d over the cells.
  double sum_squares_ = 0;  // Sum of d^2.
};

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
  // Estimate of w below: sqrt(max(0, U)) by CellEffect. With impossible
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
// its unbiased estimate (CellEffect). log_p_upper rejects "w <= null_effect", log_p_lower
// rejects "w >= null_effect". Cells of probability zero count as one of probability t, the
// tolerance. There w <= w0 means a share of at most t + w0 sqrt(t) of the observations (binomial,
// if there are any). Either test at half the level rejects "w <= w0". Both are needed to reject "w
// >= w0". With errors, "w <= w0" is tested at w0 + r and "w >= w0" at w0 - r. To first order in e /
// p0 that is the triangle inequality. Statistic: CellEffect::statistic. Asymptotic. Throws
// std::domain_error below 4 observations.
TestResult chi_square_fit_effect(const ChiSquareFit& fit, double null_effect);

// Evidence about w by distance_evidence; about w = 0 by chi_square_fit's own test.
Evidence chi_square_evidence(const ChiSquareFit& fit);

// Counts of two independent samples in the same cells. The cells are fixed beforehand, or chosen
// from the values of both together.
struct TwoSampleCounts {
  std::vector<std::uint64_t> x;
  std::vector<std::uint64_t> y;
};

struct PooledPair {
  std::uint64_t x = 0;
  std::uint64_t y = 0;
  double part = 0;                   // Contribution to X2.
  std::vector<std::size_t> members;  // Indices of the caller's cells.
};

// X2 of two samples of m and n values in cells (below). Its noncentrality is observations w^2,
// observations = m n / (m + n).
struct ChiSquareStatistic {
  double value = 0;
  double degrees_of_freedom = 1;
  double observations = 1;

  // sqrt(max(0, X2 - nu) / observations), the estimate of w.
  double effect() const;
};

struct ChiSquareTwoSample {
  TestResult test;  // log_p_upper is the p-value of "one law over the cells".
  ChiSquareStatistic statistic;
  std::vector<PooledPair> cells;
};

// Null hypothesis: both samples have the same probabilities over the cells.
//   X2 = sum (sqrt(n/m) a - sqrt(m/n) b)^2 / (a + b),  m and n the sizes.
// Chi-square with nu = pools - 1 (Pearson 1911). Cells are pooled in index order until both samples
// are expected to have 20 in each. Pooling looks at the totals a + b alone. Given
// those the null law is hypergeometric, so the choice costs nothing. Cells without a value in
// either sample do not count. The effect is
//   w = sqrt(sum (p - q)^2 / pi),  pi = (m p + n q) / (m + n).
// X2 is near noncentral chi-square of ncp = w^2 m n / (m + n). Asymptotic. Throws
// std::domain_error: lengths differ, an empty sample, fewer than two pools.
ChiSquareTwoSample chi_square_two_sample(const TwoSampleCounts& counts);

// X2 against the noncentral chi-square of ncp = observations null_effect^2: log_p_upper rejects
// "w <= null_effect", log_p_lower rejects "w >= null_effect". Asymptotic. Throws std::domain_error
// for a negative null_effect.
TestResult chi_square_effect(const ChiSquareStatistic& statistic, double null_effect);

// The same of two samples; about w = 0 by chi_square_two_sample's own test.
Evidence chi_square_evidence(const ChiSquareTwoSample& fit);

// A value of two coordinates; of one coordinate the second is 0.
struct PlanePoint {
  double first = 0;
  double second = 0;
};

// Cells of the whole plane: bands of the first coordinate, each cut along the second. Only borders
// between cells are kept, so the outermost cells have no end. A value on a border is in the upper
// cell.
struct SampledCells {
  std::vector<double> band_borders;              // Ascending, one fewer than bands.
  std::vector<std::vector<double>> cut_borders;  // One vector per band.
  std::vector<std::size_t> before;               // Number of cells in the bands before each.

  std::size_t size() const { return before.back() + cut_borders.back().size() + 1; }
  std::size_t index(PlanePoint point) const;
};

struct CellNumbers {
  std::size_t bands = 16;
  std::size_t cuts = 16;  // Number in each band.
};

// Cells that hold about as many of the points each. Borders are quantiles of the first coordinate,
// then of the second within each band. If values repeat there are fewer cells. Throws
// std::domain_error: no points, values not finite, numbers of 0.
SampledCells sampled_cells(std::vector<PlanePoint> points, CellNumbers numbers);

}  // namespace assay::stats
