#pragma once

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Squared norm of the bias E a - E b of two images, without the noise of their means:
//   U = sum over elements ((mean a - mean b)^2 - va - vb),    E U = sum (E a - E b)^2.
// Here va and vb are the squared errors of the means, or se^2 of a reference. U may be negative.
// Beside it stands the squared norm that a margin is relative to: N = sum (mean b^2 - vb) is
// unbiased for ||E b||^2. Variances and covariance are the jackknife's over replicates, each
// stack's left out in turn (Efron & Stein 1981: on average not too small). It allows for correlated
// elements. Degrees: the smaller count of replicates, less one. A reference's own error is
// subtracted, but the variance that it adds is not included; image_reference_error.h adds that.
struct ImageDistance {
  double squared_bias = 0;
  double squared_norm = 0;
  double bias_variance = 0;
  double norm_variance = 0;
  double covariance = 0;
  double degrees = 0;
};

// These throw std::domain_error as welch_z does.
template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageStack<Real>& b,
                             const ForEach& for_each = one_by_one);
template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageReference& b,
                             const ForEach& for_each = one_by_one);

// The same with an exact norm: a margin in units of its root.
ImageDistance with_norm(ImageDistance distance, double squared_norm);

// The same with the norm of another image, of which `norm` is the distance from 0. Their errors
// count as independent.
ImageDistance relative_to(ImageDistance distance, const ImageDistance& norm);

// Null hypothesis: ||E a - E b||^2 >= squared_margin N. Statistic: (U - squared_margin N) / its
// jackknife standard error; Student's t. log_p_lower is the p-value, small when the images are
// equivalent within the margin. log_p_upper tests ||E a - E b||^2 <= squared_margin N. Asymptotic.
// A negative squared margin only serves to invert for an interval of U / N. ZeroVariance for a zero
// standard error.
TestResult squared_margin_test(const ImageDistance& distance, double squared_margin);

}  // namespace assay::stats
