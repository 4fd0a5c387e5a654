#pragma once

#include <cstdint>

namespace assay::stats {

// The finaliser of Steele, Lea and Flood (2014): every bit of x flips each bit of the result with
// probability near 1/2.
constexpr std::uint64_t splitmix64_finalised(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace assay::stats
