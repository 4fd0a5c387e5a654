#pragma once

#include "stats/images/image.h"
#include "stats/images/image_equivalence.h"

namespace assay::stats {

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
// adds nothing. Throws std::domain_error as image_distance does.
template <class Real>
ImageDistance with_reference_error(ImageDistance distance, const ImageStack<Real>& a,
                                   const ImageReference& b, ElementErrors errors);

}  // namespace assay::stats
