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

/// max(1, K V^exponent rounded) with the largest K whose counts together are at most mean_count
/// times the number of pixels. Noise V / N is equal for exponent 1 where lens samples are
/// independent, for 2/3 where they are jittered across an edge (their error falls like N^-3/2);
/// the sum of V / N is least for 1/2 (Neyman 1934). Where all V are zero: one sample each.
std::vector<std::uint64_t> lens_counts(std::span<const double> variances, const Allocation& plan);

}  // namespace assay::depth_of_field
