#pragma once

#include <cstddef>
#include <span>

#include "stats/basics/moments.h"
#include "stats/images/image.h"

namespace assay::stats {

// Moments up to order four of the elements [first, first + out.size()) over the images of a stack.
// Two passes over pieces that stay in the cache: first the mean, then sums of powers of deviations
// from it. An element that never varied has m2 = 0 exactly. Each element's moments depend on its
// own values alone, so a caller may split the elements in any way. A non-finite value makes its
// element's m2 non-finite.
template <class Real>
void element_moments(const ImageStack<Real>& stack, std::size_t first, std::span<Moments> out);

}  // namespace assay::stats
