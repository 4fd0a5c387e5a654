#pragma once

#include <cstdint>
#include <span>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"

namespace assay::stats {

// Are two images equal? Their difference is looked at on every scale at once: sums over cells from
// one element to the whole image (image_windows.h), the whole image with alternating signs, and the
// energy, a sum of squares over all elements. One family p-value covers all of it (image_family.h).

// A map of z-values of known variance: under the null hypothesis independent and N(0, 1). A cell of
// k tested elements has z = sum z / sqrt k; the energy sum z^2 is chi-square, its upper tail is
// used. Exact. `untested` marks (non-zero) elements whose z is no random number, equal constants;
// empty: all are tested. An infinite z is a certain difference.
// Throws std::domain_error for wrong sizes and NaN.
struct ZMap {
  ImageExtent extent;
  std::span<const double> z;
  std::span<const unsigned char> untested = {};
};
ImageFamily image_pyramid(const ZMap& map);

// Replicates of two images, or of one against a reference. Null hypothesis: E a = E b at every
// element.
//
// Cells: the replicates are dealt to two halves; each half's variances, steadied by those of 3 x 3
// neighbours, give the other half its weights w ~ 1 / sqrt(va + vb), 0 where the element did not
// vary. A replicate's cell value is its weighted sum, T the Welch statistic of (mean of a - mean of
// b), averaged over the halves, from the variances of the cell values over replicates. Weights and
// values are independent, so the numerator has mean zero for any law of the elements, and
// correlation between elements is in the variance: adding up the elements' own z would be wrong for
// both (README.md has the rates). Single elements: welch_z.
//
// Energy: with D = mean a - mean b of halves 0 and 1 and v the squared errors of D,
//   u = w1^2 (D0^2 - v0) + w0^2 (D1^2 - v1) + 2 w0 w1 D0 D1,     E u = (bias (w0 + w1))^2
// summed over elements and divided by sqrt(sum u^2): normal for many independent elements, upper
// tail. It needs independent elements. For others (reconstruction filters, Metropolis chains,
// shared points) leave `energy` out, and add_energy the p-value of a sign flip (image_sign_flip.h).
//
// Asymptotic: Welch's law.
// Throws std::domain_error as welch_z does, and for weights of another number than the elements,
// negative or not finite.
// The energy's cross term has mean zero where the halves weigh each other only if an element's
// variance in a half says nothing of its mean there: not of skewed differences. Leave it out then.
//
// Cells smaller than `smallest` are left out of the family (their share stays unspent; different
// constants still are certain): large sums thin out their elements' skewness, small ones do not,
// and with 16 skewed replicates of unlike variance the level's part of single elements is exceeded
// sevenfold. cell_tails of image_cell_skewness.h says of a pilot which sizes keep theirs.
//
// `weights` of the elements in cells and energy, where they are known from other data (a pilot):
// both halves then take them. A rare light that half the replicates did not see is weighted like a
// quiet element by them, and sums of any size are skewed; a larger pilot has seen it.
//
// Elements of `only_in_sums`, in rising order, are part of cells and energy and take no part alone:
// their z is 0, and where they never varied they are no certain difference.
//
// `z` receives welch_z of every other element, where it has room for them. `for_each` may look at
// bands of the images at the same time.
struct PyramidOptions {
  bool energy = true;
  std::uint32_t smallest = 1;  // 1: single elements too
  std::span<const double> weights = {};
  std::span<const std::size_t> only_in_sums = {};
  std::span<double> z = {};
  ForEach for_each = one_by_one;
};
// The share of the level that the sum over the whole image has: what a difference that is the same
// everywhere is found by.
double whole_image_share(const ImageExtent& extent);

template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageStack<Real>& b,
                          const PyramidOptions& options = {});
template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageReference& b,
                          const PyramidOptions& options = {});

}  // namespace assay::stats
