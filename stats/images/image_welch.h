#pragma once

#include <cstddef>
#include <span>

#include "stats/images/image.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Welch's test element by element. Null hypothesis: E a = E b, variances free (Welch 1947;
// welch_t.h).
//   T  = (mean a - mean b) / sqrt(va + vb),   v = m2 / (n (n - 1)).
//   Degrees:  (va + vb)^2 / (va^2 / (na - 1) + vb^2 / (nb - 1)).
// A reference has v = se^2, and its term of the degrees is 0. The result z has the normal tail of T
// (t_to_z.h), and z > 0 where a is brighter. If neither side varies there is no T. Equal constants
// then have z = 0 and do not count as tested. Different constants have z = +-infinity, a certain
// difference.
struct WelchCounts {
  std::size_t tested = 0;
  std::size_t equal_constants = 0;
  std::size_t different_constants = 0;

  void merge(const WelchCounts& other);
};

// z of the elements [first, first + z.size()), in one thread. Ranges are independent of each other.
// `a` and `b` may differ in count. All throw std::domain_error: extents that differ, fewer than 16
// replicates (image.h), a range beyond the image, non-finite values (naming the element).
template <class Real>
WelchCounts welch_z(const ImageStack<Real>& a, const ImageStack<Real>& b, std::size_t first,
                    std::span<double> z);
template <class Real>
WelchCounts welch_z(const ImageStack<Real>& a, const ImageReference& b, std::size_t first,
                    std::span<double> z);

// One element's T and its exact tails. Throws ZeroVariance where neither side varies.
template <class Real>
TestResult welch_element(const ImageStack<Real>& a, const ImageStack<Real>& b, std::size_t element);
template <class Real>
TestResult welch_element(const ImageStack<Real>& a, const ImageReference& b, std::size_t element);

}  // namespace assay::stats
