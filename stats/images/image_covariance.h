#pragma once

#include <cstdint>

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

// Noise and brightness of an observation of an image, of covariance C over its elements.
struct ImageNoise {
  double trace = 0;         // tr C
  double root = 0;          // sqrt tr C^2, an upper limit.
  double of_mean = 0;       // Upper limit of a channel's mean's variance, times columns and rows.
  double squared_norm = 0;  // Squared norm of the mean.

  // Adds the noise of one more side, times the square of its factor, in means of `averaged`
  // observations each. The root of two sides is at most the sum of theirs.
  void add(const ImageNoise& side, double square, double averaged);
};

// By replicates of a pilot: upper limits are two standard errors above the estimates, because
// pilots of heavy noise differ.
ImageNoise noise_of_pilot(const ImageStack& pilot, const ForEach& for_each = one_by_one);

// The margins of theta = ||E a - E b|| / unit.
struct ImageMargins {
  double allow = 0;
  double detect = 0;
  double squared_unit = 1;
};

// The least replicates, by steps of an eighth and `most` at most, that exclude `detect` with
// probability 1 - beta if there is no difference. Let noise have rank d, and s = root / sqrt(d) /
// n. The squared distance is then s (chi^2 - d), and its jackknife error 2 s chi. The distance
// between the whole images' means is excluded too, by both one-sided tests.
std::uint64_t image_sample_size(const ImageNoise& noise, const ImageMargins& margins, double beta,
                                std::uint64_t most);

}  // namespace assay::stats
