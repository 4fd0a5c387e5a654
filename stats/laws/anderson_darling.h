#pragma once

#include <cstdint>
#include <span>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// ln P(A2 >= x) for n values under the null hypothesis. In the limit A2 is the sum of chi-square
// variables over j (j + 1) (Anderson & Darling 1952). Its upper tail is Smirnov's alternating
// series, with y = (w^2 - 1) / 4:
//   P = 1/pi sum_k (-1)^(k+1) integral over w in (4k-1, 4k+1) of
//       e^(-x (w^2-1)/8) (w/2) sqrt(pi / (y cos(pi (w-4k)/2))) dw.
// The relative error of this tail is 1e-10 at any depth. For a finite sample it is multiplied by 1
// + max(0, x - 1) / 5n. This factor was fitted to importance sampling for n = 5 to 200. It is right
// within .03 of p down to p = 1e-5, and up to .1 too large down to 1e-9. Throws std::domain_error:
// n < 5, x not finite.
double log_anderson_darling_upper(double x, std::uint64_t n);

// Null hypothesis: the sample follows a continuous law, known up to `error` >= sup |law - given|.
// `at` holds u_i = F(x_i) of the sorted values.
//   A2 = -n - (1/n) sum (2i - 1) (ln u_i + ln(1 - u_{n+1-i})).
// It weighs the tails more than Kolmogorov and Smirnov's distance does. The statistic is the least
// A2 over all u_i within error of F(x_i). So p is an upper bound over all such laws. A2 falls as
// u_i nears (2i - 1) / 2n, the only minimum of its term. A value where even then F is 0 or 1 is
// impossible under the null hypothesis, and A2 is the largest double. log_p_upper is the p-value,
// log_p_lower 0. Throws std::domain_error: fewer than 5 values, probabilities outside [0, 1], a
// negative or infinite error.
TestResult anderson_darling(Probabilities at, double error);

}  // namespace assay::stats
