#pragma once

#include "stats/basics/for_each.h"
#include "stats/images/image.h"

namespace assay::stats {

// The covariance C of an image's elements, as far as the size of a mean's noise depends on it.
struct ImageCovariance {
  double trace = 0;                // tr C, the sum of variances.
  double squared_trace = 0;        // tr C^2; its error is in heavy tails as large as itself.
  double squared_trace_error = 0;  // Standard error, by the jackknife over pairs.
  double squared_mean = 0;         // ||E x||^2.

  // The degrees of the chi-square whose shape the squared norm of the noise has (Satterthwaite
  // 1946).
  double degrees() const { return trace * trace / squared_trace; }
};

// Unbiased for each but the degrees: from differences y of pairs of replicates, E (y_k . y_l)^2 =
// tr C^2. At most 256 replicates are used. Throws std::domain_error for fewer than 16.
ImageCovariance image_covariance(const ImageStack& stack, const ForEach& for_each = one_by_one);

// squared_mean alone, with the same bits.
double image_squared_mean(const ImageStack& stack);

}  // namespace assay::stats
