#pragma once

#include <cstddef>
#include <cstdint>

namespace assay::stats {

// Simultaneous bands of an empirical distribution function (Saeilynoja, Buerkner & Vehtari 2022).
// The statistic is that of Berk & Jones 1979 at a grid of points. The count of values up to a point
// z is binomial. A pointwise band leaves gamma / 2 in each tail. gamma is chosen so that the whole
// path stays inside with the stated probability. A forward recursion over the points makes that
// exact for every sample size. In the tails the band is narrower than Kolmogorov and Smirnov's.
//
// The pointwise error gamma at which intervals of Clopper & Pearson (binomial.h) hold their law all
// together with this confidence. They stand at points - 1 equally spaced order statistics of n
// values. gamma is exact up to n = 1000, to 1e-6 relative. Beyond, it falls to a limit like 1 /
// sqrt(n). The limit is given, extrapolated from n = 1000 and 4000. Throws std::domain_error: n <
// 1, points < 2, confidence outside (0, 1).
double simultaneous_error(std::uint64_t n, std::size_t points, double confidence);

}  // namespace assay::stats
