#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Values declared to lie in [low, high], low < high, both finite.
struct Range {
  double low = 0;
  double high = 1;
};

// Null hypothesis: E x = null_mean, for independent values in a declared range and any n. It needs
// the moments alone, so blocks may be merged in any order. Below, m is the null mean on the unit
// scale and L = ln(1 / p). Each tail is three times the smallest of three bounds.
// The mean's bound (Hoeffding 1963, theorem 1; Bentkus 2004, theorem 1.2):
//   min(exp(-n KL(mean || m)), e P(Binomial(n, m) as extreme as n mean)).
// The variance's bound (Maurer & Pontil 2009, theorem 4), with K = L + ln 2:
//   |mean - m| = sqrt(2 s2 K / n) + 7 K / (3 (n - 1)).
// The bets' bound 1 / E (Waudby-Smith & Ramdas 2024; Ville 1939):
//   E = (1/4) sum_l prod_i (1 + l z_i),  l = 7/8, 1/2, 1/4, 1/8.
// Here z = (m - x) / (1 - m) below and (x - m) / m above.
// Two sums bound each product (Fan, Grama & Liu 2015, lemma 4.1):
//   prod_i (1 + l z_i) >= exp(l sum z - psi(l) sum z^2).
// Here psi(l) = -ln(1 - l) - l.
// The bets are strong where the null mean is near the end of the range that matters. The statistic
// is mean - null_mean. Its law is "bound": P(p <= a) <= a, usually far below. A null mean outside
// the range is impossible: the tail that rejects it has the lowest logarithm. Throws
// std::domain_error: count < 2, an empty or infinite range, values outside it, a non-finite null
// mean.
TestResult bounded_mean(const Moments& x, Range range, double null_mean);

}  // namespace assay::stats
