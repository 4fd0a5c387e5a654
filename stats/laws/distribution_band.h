#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace assay::stats {

// Simultaneous bands of an empirical distribution function (Saeilynoja, Buerkner & Vehtari 2022).
// The statistic is that of Berk & Jones 1979 at a grid of points. The count of values up to a point
// z is binomial. A pointwise band leaves gamma / 2 in each tail. gamma is chosen so that the whole
// path stays inside with the stated probability. A forward recursion over the points makes that
// exact for every sample size. In the tails the band is narrower than Kolmogorov and Smirnov's.

// A point at which the path is looked at: z_i = i / points, i = 1 .. points - 1.
struct BandPoint {
  double z = 0;           // Probability under the null law.
  std::uint64_t low = 0;  // Smallest and largest count inside the band.
  std::uint64_t high = 0;
};

struct DistributionBand {
  std::vector<BandPoint> points;
  double gamma = 0;     // Pointwise error.
  double coverage = 0;  // Coverage of the whole path, at least the confidence asked for.
};

// Band for the number of values up to the null law's quantiles z_i, for n independent values. The
// coverage is a step function of gamma, so it exceeds `confidence` by a little. Throws
// std::domain_error: n < 1, points < 2, confidence outside (0, 1).
DistributionBand ecdf_band(std::uint64_t n, std::size_t points, double confidence);

// The pointwise error gamma at which intervals of Clopper & Pearson (binomial.h) hold their law all
// together with this confidence. They stand at points - 1 equally spaced order statistics of n
// values. It is the band's gamma above, exact up to n = 1000. Beyond, gamma falls to a limit like 1
// / sqrt(n). The limit is given, extrapolated from n = 1000 and 4000. Throws as ecdf_band.
double simultaneous_error(std::uint64_t n, std::size_t points, double confidence);

}  // namespace assay::stats
