#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/tails/evidence.h"

namespace assay::stats {

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

// Central interval of w: effect_interval of cell_effect.h.
Interval chi_square_effect_interval(const ChiSquareStatistic& statistic, double confidence);

// Evidence about w; about w = 0 by chi_square_two_sample's own test.
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
