#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/basics/two_sizes.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Simultaneous bands of an empirical distribution function (Saeilynoja, Buerkner & Vehtari 2022;
// the statistic is that of Berk & Jones 1979 at a grid of points). At evaluation point z the count
// of values up to z is binomial; a pointwise band leaves gamma / 2 in each of its tails, and gamma
// is chosen so that the whole path stays inside with the stated probability, by a forward recursion
// over the points that is exact for every sample size. Compared with Kolmogorov and Smirnov's band
// it is narrower in the tails.

// Where the path is looked at: z_i = i / points, i = 1 .. points - 1.
struct BandPoint {
  double z = 0;            // probability under the null law; of the pooled sample for two samples
  std::uint64_t rank = 0;  // two samples: the number of pooled values up to here; one sample: 0
  std::uint64_t low = 0;   // smallest and largest count inside the band
  std::uint64_t high = 0;
};

struct DistributionBand {
  std::vector<BandPoint> points;
  double gamma = 0;     // pointwise error
  double coverage = 0;  // of the whole path, at least the confidence asked for
};

// Of the number of values up to the null law's quantiles z_i, for n independent values. The
// coverage is a step function of gamma, so it exceeds `confidence` by a little. Throws
// std::domain_error: n < 1, points < 2, confidence outside (0, 1).
DistributionBand ecdf_band(std::uint64_t n, std::size_t points, double confidence);

// Of the number of x among the first r_i of the pooled sorted values, r_i = i (m + n) / points
// rounded, when both samples have one continuous law: hypergeometric. m, n >= 1.
DistributionBand ecdf_band(TwoSizes sizes, std::size_t points, double confidence);

// The pointwise error gamma at which the intervals of Clopper & Pearson (binomial.h), at points - 1
// equally spaced order statistics of n values, hold their law all together with this confidence:
// that of the band above, exact up to n = 1000. Beyond, gamma falls to a limit like 1 / sqrt(n),
// and the limit is given, by extrapolation from n = 1000 and 4000: at .99 and 64 points 3 % below
// what n = 1e5 allows. Throws as ecdf_band.
double simultaneous_error(std::uint64_t n, std::size_t points, double confidence);

struct BandTest {
  TestResult test;
  BandPoint worst;          // where the pointwise error is smallest; its band at that very error
  std::uint64_t count = 0;  // observed there
};

// Null hypothesis: the values are independent and uniform on [0, 1] (probability transforms of a
// continuous law). statistic = gamma, the smallest over the points of twice the smaller binomial
// tail; log_p_upper = ln P(gamma as small), exact. Below 1e-200 the p-value is the sum of the
// pointwise ones, (points - 1) gamma. log_p_lower is 0. Throws std::domain_error: unsorted values
// or values outside [0, 1], points < 2.
BandTest band_test(std::span<const double> sorted_uniforms, std::size_t points);

// Null hypothesis: two independent samples of one law. Evaluated at those r_i moved up to the end
// of their group of ties, where the law given the pooled values is hypergeometric, ties or not:
// exact.
BandTest band_test(std::span<const double> sorted_x, std::span<const double> sorted_y,
                   std::size_t points);

}  // namespace assay::stats
