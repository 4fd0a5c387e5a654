#pragma once

#include <cstddef>
#include <span>

#include "stats/basics/moments.h"
#include "stats/images/image.h"

namespace assay::stats {

// Moments up to order four of the elements [first, first + out.size()) over the images of a stack,
// in two passes over pieces that stay in the cache: the mean as the first image's value plus the
// mean difference to it, then sums of powers of deviations from that mean. An element that never
// varied has m2 = 0 exactly. Each element's moments depend on its own values alone, so that a
// caller may split the elements in any way. The values must be finite: an element with others gets
// m2 that is not.
template <class Real>
void element_moments(const ImageStack<Real>& stack, std::size_t first, std::span<Moments> out);

}  // namespace assay::stats
