#pragma once

// How many lens samples each pixel gets.

#include <cstdint>
#include <span>
#include <vector>

namespace assay::depth_of_field {

/// How much there is to give away, and how.
struct Allocation {
  double mean_count = 0;  ///< lens samples a pixel on average, 1 or more
  double exponent = 1;    ///< counts go with the variance to this power; 0 is uniform
};

/// Counts max(1, K V^exponent rounded). K is the largest with a total of at most mean_count times
/// the number of pixels. If all V are zero there is one sample each.
///
/// Exponent 1 makes the noise V / N equal for independent lens samples. Exponent 2/3 does so for
/// jittered ones across an edge, whose error falls like N^-3/2. Exponent 1/2 makes the sum of V / N
/// least (Neyman 1934).
std::vector<std::uint64_t> lens_counts(std::span<const double> variances, const Allocation& plan);

}  // namespace assay::depth_of_field
