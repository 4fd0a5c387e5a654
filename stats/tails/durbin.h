#pragma once

#include <cstdint>

namespace assay::stats {

// Internal. The result is ln P(D <= d). P is n! / n^n times an entry of the n-th power of Durbin's
// (2k-1) x (2k-1) matrix, k = floor(n d) + 1. (Marsaglia, Tsang & Wang 2003, equation 1.) All terms
// but the corner column are positive, so the result keeps about 13 digits. Cost (2k)^3 log n.
double log_durbin_lower(double distance, std::uint64_t n);

}  // namespace assay::stats
