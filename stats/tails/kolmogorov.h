#pragma once

#include <cstdint>

#include "stats/tails/tails.h"

namespace assay::stats {

// The law of D = sup |F_n - F| for n independent values of a continuous law F. Relative errors are
// 1e-10 by the matrix and 2e-9 in the upper tail. The expansion's absolute error is 4e-9. Small D
// use Durbin's matrix in the form of Marsaglia, Tsang & Wang (JSS 8(18), 2003) where it is
// affordable. The rest of the body uses the expansion of Pelz & Good (JRSS B 38, 1976). The upper
// tail is twice Smirnov's one-sided tail with its leading correction. The division of the range
// follows Simard & L'Ecuyer (JSS 39(11), 2011). Throws std::domain_error for n = 0 and for
// distances outside [0, 1].
LogTails kolmogorov_tails(double distance, std::uint64_t n);

// ln P(sup (F_n - F) >= distance), Smirnov's one-sided law (Birnbaum & Tingey 1951, equation 3.0).
// Throws as kolmogorov_tails.
double log_smirnov_one_sided(double distance, std::uint64_t n);

// ln P(K >= z) of the limit law of sqrt(n) D: K(z) = 2 sum (-1)^(k-1) exp(-2 k^2 z^2).
// Throws std::domain_error for z below 0.
double log_kolmogorov_limit(double z);

// The distance d with P(D >= d) = exp(log_probability). Throws std::domain_error for n = 0 and for
// a logarithm that is not below 0.
double kolmogorov_upper_quantile(double log_probability, std::uint64_t n);

}  // namespace assay::stats
