#pragma once

#include <cstdint>
#include <span>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"

namespace assay::stats {

// Are two images equal? Their difference is looked at on every scale at once. There are sums over
// cells from one element to the whole image (image_windows.h), and the whole image with alternating
// signs. The energy is a sum of squares over all elements. One family p-value covers all of it
// (image_family.h).

// Replicates of two images, or of one against a reference. Null hypothesis: E a = E b at every
// element. Asymptotic (Welch's law).
//
// Cells: the replicates are dealt to two halves. Each half gives the other its weights w ~ 1 /
// sqrt(va + vb), from variances steadied by those of 3 x 3 neighbours. A constant element has
// weight 0. A replicate's cell value is its weighted sum. T is the Welch statistic of the cell
// values over replicates, averaged over the halves. Weights and values are independent, so the
// numerator has mean zero for any law of the elements. Correlation between elements is in the
// variance. Adding up the elements' own z would fail at both (measurements.md). Single elements:
// welch_z.
//
// Energy: D is mean a - mean b in halves 0 and 1, v its squared errors. The sum is over
//   u = w1^2 (D0^2 - v0) + w0^2 (D1^2 - v1) + 2 w0 w1 D0 D1.
// Here E u = (bias (w0 + w1))^2. The statistic is sum u / sqrt(sum u^2), normal for many elements,
// upper tail. It needs independent elements, and differences that are not skewed. For
// reconstruction filters, Metropolis chains or shared points leave `energy` out. Then add_energy
// the p-value of a sign flip (image_sign_flip.h).
//
// `smallest`: smaller cells leave the family, and their share stays unspent. Different constants
// still are certain. Large sums thin out their elements' skewness, small ones do not. The function
// cell_tails (image_cell_skewness.h) says which sizes keep their level.
//
// Given `weights` in cells and energy come from other data, such as a pilot. Both halves then take
// them. A pilot larger than a half has seen rare lights that half the replicates miss.
//
// Elements of `only_in_sums`, in rising order, are part of cells and energy but take no part alone.
// Their z is 0, and they are no certain difference.
//
// The span `z` receives welch_z of every other element, if it has room. Bands of the images may be
// looked at at the same time (`for_each`).
//
// Throws std::domain_error as welch_z does, and for weights of a wrong number, negative or not
// finite.
struct PyramidOptions {
  bool energy = true;
  std::uint32_t smallest = 1;  // 1: single elements too.
  std::span<const double> weights = {};
  std::span<const std::size_t> only_in_sums = {};
  std::span<double> z = {};
  ForEach for_each = one_by_one;
};
// Share of the level for the sum over the whole image, which finds a uniform difference.
double whole_image_share(const ImageExtent& extent);

template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageStack<Real>& b,
                          const PyramidOptions& options = {});
template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageReference& b,
                          const PyramidOptions& options = {});

}  // namespace assay::stats
