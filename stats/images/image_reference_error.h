#pragma once

#include "stats/images/image.h"
#include "stats/images/image_equivalence.h"

namespace assay::stats {

// Whether the errors of a reference's elements are independent, or nothing is known of them.
enum class ElementErrors { independent, unknown };

// The distance of a stack from a reference with the variances that the reference's own errors se
// add to those of the stack's jackknife. With d = mean a - b, va the squared error of mean a, an
// element adds to the variances of U and N and to their covariance
//   4 max(0, d^2 - va - se^2) se^2 + 4 va se^2 + 2 se^4,
//   4 max(0, b^2 - se^2) se^2 + 2 se^4,   -4 d b se^2 - 2 se^4
// (of normal errors, the squares of the means without bias). Independent errors add up; of unknown
// ones the squares of the sums of the roots are added, and the largest covariance, and |d| plus two
// of its standard errors stands for the root of max(0, ...) in the first. Nothing where the
// reference is exact. Throws std::domain_error as image_distance does.
template <class Real>
ImageDistance with_reference_error(ImageDistance distance, const ImageStack<Real>& a,
                                   const ImageReference& b, ElementErrors errors);

}  // namespace assay::stats
