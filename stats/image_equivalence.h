#pragma once

#include "stats/image.h"
#include "stats/test_result.h"

namespace assay::stats {

// Squared norms of the bias E a - E b of two images, without the noise of their means, which
// ||mean a - mean b||^2 alone would add:
//   U = sum over elements w ((mean a - mean b)^2 - va - vb),    E U = sum w (E a - E b)^2
// with va, vb the squared errors of the means, or se^2 of a reference. U may be negative.
// The standard error is the jackknife over replicates (Efron & Stein 1981: on average not too
// small), each stack's replicates left out in turn; correlated elements are in it. Degrees: the
// smaller count of replicates, less one. A reference's own error is subtracted but does not enter
// the standard error. All throw std::domain_error as welch_z does.
struct SquaredBias {
  double estimate = 0;
  double standard_error = 0;
  double degrees = 0;
};

// w = 1.
template <class Real>
SquaredBias squared_bias(const ImageStack<Real>& a, const ImageStack<Real>& b);
template <class Real>
SquaredBias squared_bias(const ImageStack<Real>& a, const ImageReference& b);

// Relative mean squared error: w = 1 / (elements (b^2 + constant)), b the mean of the second image
// or the reference, never of both. constant > 0, in squared units of the image.
template <class Real>
SquaredBias relative_bias(const ImageStack<Real>& a, const ImageStack<Real>& b, double constant);
template <class Real>
SquaredBias relative_bias(const ImageStack<Real>& a, const ImageReference& b, double constant);

// Student's interval around the estimate. Throws for a confidence outside (0, 1).
Interval squared_bias_interval(const SquaredBias& bias, double confidence);

// Null hypothesis: ||E a - E b|| >= margin ||E b||. Statistic: (U - margin^2 N) / its jackknife
// standard error, N = sum (mean b^2 - vb); Student's t. log_p_lower is the p-value: small when the
// images are equivalent within the margin. log_p_upper tests ||E a - E b|| <= margin ||E b||.
// Asymptotic. Throws for a margin that is not positive, ZeroVariance for a zero standard error.
template <class Real>
TestResult image_equivalence(const ImageStack<Real>& a, const ImageStack<Real>& b, double margin);
template <class Real>
TestResult image_equivalence(const ImageStack<Real>& a, const ImageReference& b, double margin);

}  // namespace assay::stats
