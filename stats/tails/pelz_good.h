#pragma once

#include <cstdint>

namespace assay::stats {

// Internal. P(D <= d) by the expansion K0(z) + K1(z) / n^(1/2) + K2(z) / n + K3(z) / n^(3/2) at z =
// sqrt(n) d. (Pelz & Good, JRSS B 38 (1976) 152, equations 6 to 10.) Absolute error of order n^-2.
double pelz_good_lower(double distance, std::uint64_t n);

}  // namespace assay::stats
