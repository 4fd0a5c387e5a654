#pragma once

#include <cstdint>
#include <span>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// ln P(A2 >= x) for n values under the null hypothesis. In the limit A2 is the sum of chi-square
// variables over j (j + 1) (Anderson & Darling 1952), whose upper tail is Smirnov's alternating
// series
//   P = 1/pi sum_k (-1)^(k+1) integral over w in (4k-1, 4k+1) of
//       e^(-x (w^2-1)/8) (w/2) sqrt(pi / (y cos(pi (w-4k)/2))) dw,   y = (w^2 - 1) / 4,
// computed as a tail (1e-10 relative, any depth). A finite sample multiplies it by 1 + g(x) / n,
// g = max(0, x - 1) / 5: fitted here to simulations of n = 5 to 200, which it meets within .03 of p
// down to p = 1e-5 and exceeds by at most .1 down to 1e-9 (stats/README.md). Throws
// std::domain_error: n < 5, x not finite.
double log_anderson_darling_upper(double x, std::uint64_t n);

// A2 = -n - (1/n) sum (2i - 1) (ln u_i + ln(1 - u_{n+1-i})), u = F(x): more weight on the tails
// than Kolmogorov and Smirnov's distance. `sorted` ascending; the law must be continuous (its
// left_limit is refused: atoms invalidate the law of A2). A value where F is 0 or 1 makes A2
// infinite: the null law could not have produced it, and the statistic is the largest double.
// Throws std::domain_error: fewer than 5 values, unsorted, non-finite, cdf outside [0, 1].
double anderson_darling_statistic(std::span<const double> sorted, const ContinuousLaw& law);

// Null hypothesis: the sample follows the law. log_p_upper is the p-value, log_p_lower 0.
TestResult anderson_darling(std::span<const double> sorted, const ContinuousLaw& law);

// The same of a law that is known up to `error`, sup |law - given|: the least A2 over all u_i
// within error of F(x_i), so p is an upper bound of that of every such law. A2 falls as u_i nears
// (2i - 1) / 2n, where its term has its only bottom. Throws besides: error negative or not finite.
TestResult anderson_darling(std::span<const double> sorted, const ContinuousLaw& law, double error);
// Of values whose F(x_i) are known, in the values' order. Throws as above.
TestResult anderson_darling(Probabilities at, double error);

}  // namespace assay::stats
