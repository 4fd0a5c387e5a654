#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"

namespace assay::stats {

// Internal to image_pyramid: the two halves that replicates are dealt to, even and odd indices.
inline constexpr std::size_t halves = 2;

// Of one half: D = mean a - mean b, its squared error v, and the weight that the other half takes:
// 1 / sqrt of the mean of v and of v smoothed over 3 x 3 elements of the channel, or zero where no
// replicate of the half differs from another in this element. A single element's v is from few
// values and can be tiny by chance; its weight alone would then carry the whole sum. A pixel that
// is lit in one image of thousands, seen by neither half, would by its neighbours' v weigh like
// them and bring in all of its mean.
struct Half {
  std::size_t first = 0;  // element that they begin with
  std::vector<double> difference;
  std::vector<double> variance;
  std::vector<unsigned char> varied;  // whether any replicate of the half differs from another
  std::vector<double> weight;
};

// The mean of each element's variance and that of its 3 x 3 neighbourhood in the channel.
std::vector<double> steadied(const ImageExtent& extent, const std::vector<double>& variance);

// These rows and one more at either side, where the image has one: whose variances their steadied
// ones are taken from.
RowRange with_neighbours(RowRange rows, const ImageExtent& extent);

// Of the elements of these rows, and of one more row at either side where the image has one.
// Weights are right of these rows alone.
template <class Real>
std::array<Half, halves> halves_of(const ImagePair<Real>& pair, RowRange rows,
                                   const ForEach& for_each = one_by_one);

}  // namespace assay::stats
