#pragma once

#include <array>
#include <limits>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_moments.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// Squared norm of the bias E a - E b of two images, without the noise of their means:
//   U = sum over elements ((mean a - mean b)^2 - va - vb),    E U = sum (E a - E b)^2.
// Here va and vb are the squared errors of the means, or se^2 of a reference. U may be negative.
// Beside it stands the squared norm that a margin is relative to: N = sum (mean b^2 - vb) is
// unbiased for ||E b||^2. Variances and covariance are the jackknife's over replicates, each
// stack's left out in turn (Efron & Stein 1981: on average not too small). It allows for correlated
// elements. Degrees: the smaller count of replicates, less one. A reference's own error is
// subtracted, but the variance that it adds is not included; with_reference_error adds that.
struct ImageDistance {
  double squared_bias = 0;
  double squared_norm = 0;
  double bias_variance = 0;
  double norm_variance = 0;
  double covariance = 0;
  double degrees = 0;
  // The number of elements on which U rests: (sum d^2)^2 / sum d^4, d = mean a - mean b. Rare light
  // that one side missed in few of them is a matter of places, whose neighbours tell of it.
  double elements = std::numeric_limits<double>::infinity();
};

// Internal: sums over elements of the terms of U and N. They are whole, and without each replicate
// in turn but for a summand that all of a side have in common.
struct DistanceSums {
  using Terms = std::array<double, 2>;
  Terms whole = {};
  std::vector<Terms> without_a = {};
  std::vector<Terms> without_b = {};
  Terms powers = {};  // d^2 and d^4.
};

// Room for the moments of elements of either side, or none.
using MomentsOfSides = std::array<MomentArrays, 2>;

// The distance of images that are read rows after rows.
class RowDistance {
 public:
  // Takes rows that follow on those before. Throws std::domain_error for unequal extents and fewer
  // than least_replicates images. The moments of the rows' elements, by moments_of_range, go where
  // there is room for them.
  void take(const ImagePair& pair, RowRange rows, const ForEach& for_each = one_by_one,
            const MomentsOfSides& moments = {});
  // To be called after the last rows. Throws std::domain_error if a sum is not finite.
  ImageDistance distance() const;

 private:
  DistanceSums sums_;
};

// The same of whole images. Throws as above.
ImageDistance image_distance(const ImagePair& pair, const ForEach& for_each = one_by_one);

// The same with the norm of another image, of which `norm` is the distance from 0. Their errors
// count as independent. With a squared bias alone the norm is exact.
ImageDistance relative_to(ImageDistance distance, const ImageDistance& norm);

// Independent errors of a reference's elements, or errors of unknown dependence.
enum class ElementErrors { independent, unknown };

// The distance of a stack from a reference, with the variances that the reference's own errors se
// add. Let d = mean a - b and va the squared error of mean a. An element adds three terms.
//   Variance of U: 4 max(0, d^2 - va - se^2) se^2 + 4 va se^2 + 2 se^4.
//   Variance of N: 4 max(0, b^2 - se^2) se^2 + 2 se^4.
//   Covariance: -4 d b se^2 - 2 se^4.
// This holds for normal errors, with unbiased squares of the means. Independent errors add up. For
// unknown ones the squares of the sums of the roots are added, and the largest covariance. There
// |d| plus two standard errors replaces the root of max(0, ...) in the first. An exact reference
// and a second stack add nothing. Throws std::domain_error as image_distance does.
ImageDistance with_reference_error(ImageDistance distance, const ImagePair& pair,
                                   ElementErrors errors);

// The squared standard error of U - squared_margin N.
double variance_at(const ImageDistance& distance, double squared_margin);

// Null hypothesis: ||E a - E b||^2 >= squared_margin N. Statistic: (U - squared_margin N) / its
// jackknife standard error; Student's t. log_p_lower is the p-value, small when the images are
// equivalent within the margin. log_p_upper tests ||E a - E b||^2 <= squared_margin N. Asymptotic.
// A negative squared margin only serves to invert for an interval of U / N. ZeroVariance for a zero
// standard error.
TestResult squared_margin_test(const ImageDistance& distance, double squared_margin);

// ---- theta = ||E a - E b|| / sqrt N, with what the squared distance does not show

struct ThetaOfImages {
  ImageDistance of_elements = {};
  double hidden = 0;           // The norm of a bias that values can hide which no element showed.
  double hidden_of_twice = 0;  // With twice the replicates.
  // The size of each channel's difference between the whole images' means, with its error. Theta is
  // at least as large.
  std::vector<Reference> of_means = {};
  // The share of alpha that U has beside a family of places (image_family.h), which tests theta = 0
  // too. It is 0 against a single image, whose own noise is part of U. There U tests a theta beyond
  // 0, with all of alpha.
  double share = 0;

  // sqrt(U / N), or 0 where U is negative.
  double estimate() const;
  // True without noise, and beside an image of zeros: the estimate is theta.
  bool exact() const;
};

// `of_means`, in units of sqrt(squared_norm).
std::vector<Reference> distances_of_means(const ChannelMeans& a, const ChannelMeans& b,
                                          const ImageExtent& extent, double squared_norm);

inline constexpr double share_of_distance = 0.25;

// Null hypothesis: theta = margin. A hidden bias may be part of theta, or make up theta. An
// estimate below 0 counts as 0, since no bias is smaller. Noise that all elements share enters the
// squared distance squared, so the jackknife misses it where it cancels a bias: the means decide as
// well. The upper p-value is over the share. Asymptotic. Throws as squared_margin_test.
TestResult theta_test(const ThetaOfImages& theta, double margin);

// Values of theta that theta_test does not reject, but for places at 0. They are found by the
// square root's signed square.
Interval theta_interval(const ThetaOfImages& theta, double confidence);

// Evidence by both, and about theta = 0 by the test of a family of places. Where no place decides
// at alpha, the distance does if it rests on many elements. What exceeds a margin differs, so
// equality must be rejected too; but a single reference's own noise is part of theta.
Evidence image_evidence(const ThetaOfImages& theta, const TestResult& of_places, double alpha);

// Replicates at which theta would be excluded from `margin` on at beta, a million times as many at
// most. It is 0 if the estimate is not below the margin. In pure noise f times the replicates
// divide the standard error of the squared bias by f. They divide it by sqrt f if there is a bias.
// A hidden bias falls like exp(-f).
double deciding_replicates(const ThetaOfImages& theta, double margin, double beta,
                           double replicates);

}  // namespace assay::stats
