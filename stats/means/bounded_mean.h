#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Values declared to lie in [low, high], low < high, both finite.
struct Range {
  double low = 0;
  double high = 1;
};

// Null hypothesis: E x = null_mean, for independent values in a declared range; nothing else is
// assumed, and nothing is asked of n. From the moments alone, so blocks may be merged in any order.
// On the unit scale, m the null mean, L = ln(1 / p), each tail is the smallest of three bounds,
// times three because which of them is smallest depends on the data:
//   the mean's:      min(exp(-n KL(mean || m)), e P(Binomial(n, m) as extreme as n mean))
//                    (Hoeffding 1963, theorem 1; Bentkus 2004, theorem 1.2: both bound one tail)
//   the variance's:  |mean - m| = sqrt(2 s2 (L + ln 2) / n) + 7 (L + ln 2) / (3 (n - 1)), for L
//                    (Maurer & Pontil 2009, theorem 4)
//   the bets':       1 / E,  E = (1/4) sum_l prod_i (1 + l z_i),  l = 7/8, 1/2, 1/4, 1/8,
//                    z = (m - x) / (1 - m) below and (x - m) / m above: wealth of constant bets
//                    against the null (Waudby-Smith & Ramdas 2024; Ville 1939), of which moments
//                    tell at least  prod_i (1 + l z_i) >= exp(l S1 - psi(l) S2),  S1 = sum z,
//                    S2 = sum z^2, psi(l) = -ln(1 - l) - l  (Fan, Grama & Liu 2015, lemma 4.1)
// The bets know how near the null mean is to the end of the range that matters: values of a
// thousandth of their range are shown to be too large with some five hundredth of the values.
// The statistic is mean - null_mean, its law "bound": P(p <= a) <= a, usually far below. A null
// mean outside the range is impossible: the tail that rejects it has the lowest logarithm. Throws
// std::domain_error: count < 2, an empty or infinite range, values outside it, a non-finite null
// mean.
TestResult bounded_mean(const Moments& x, Range range, double null_mean);

// Central interval of E x by inversion, inside the range; coverage at least `confidence`.
Interval bounded_mean_interval(const Moments& x, Range range, double confidence);

}  // namespace assay::stats
