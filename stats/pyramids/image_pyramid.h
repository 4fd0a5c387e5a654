#pragma once

#include <span>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"

namespace assay::stats {

// Are two images equal? Their difference is looked at on every scale at once. Cells have one
// element to the whole image (image_windows.h); one more sum has alternating signs. A family
// p-value covers all of it (image_family.h).
//
// Replicates of two images, or of one against a reference. Null hypothesis: E a = E b at every
// element. Asymptotic (Welch's law).
//
// The replicates are dealt to two halves. Each half gives the other its weights w ~ 1 /
// sqrt(va + vb), from variances steadied by those of 5 x 5 neighbours. A constant element has
// weight 0. A replicate's cell value is its weighted sum. T is the Welch statistic of the cell
// values over replicates, averaged over the halves. Weights and values are independent, so the
// numerator has mean zero for any law of the elements. Correlation between elements is in the
// variance. Adding up the elements' own z would fail at both (measurements.md).
//
// Rare bright values (fireflies) make T too large where one image has them and missed them. So a
// cell's T is only as large as its neighbours allow (image_noise.h). What no replicate of the whole
// image shows, no test knows.
//
// The span `z` receives T of every element by its own noise as a normal z, if it has room. Bands of
// the images may be looked at at the same time (`for_each`).
//
// An element that never varied is in sums, with a weight if its neighbours vary. If it differs, it
// is a finding by itself, unless values that it never showed may make up the difference
// (`constants_decide`).
//
// Throws std::domain_error for unequal extents, fewer than least_replicates images, values that are
// not finite, and a negative standard error of a reference.
struct PyramidOptions {
  std::span<double> z = {};
  ForEach for_each = one_by_one;
  bool constants_decide = true;
};

template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageStack<Real>& b,
                          const PyramidOptions& options = {});
template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageReference& b,
                          const PyramidOptions& options = {});

}  // namespace assay::stats
