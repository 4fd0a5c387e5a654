#pragma once

#include <cstdint>

namespace assay::stats {

// Sizes of two samples.
struct TwoSizes {
  std::uint64_t m = 1;
  std::uint64_t n = 1;
};

}  // namespace assay::stats
