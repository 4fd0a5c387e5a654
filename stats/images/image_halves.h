#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"

namespace assay::stats {

// Internal to image_pyramid: replicates are dealt to two halves, even and odd indices.
inline constexpr std::size_t halves = 2;
inline std::size_t half_count(std::size_t replicates, std::size_t half) {
  return (replicates + 1 - half) / halves;
}

// One half: D = mean a - mean b, its squared error v, and the weight that the other half takes. The
// weight is 1 / sqrt of the mean of v and of v smoothed over 5 x 5 elements of the channel. It is
// zero if none of these varies within the half. A single element's v is from few values, and one
// that is tiny by chance would carry the whole mean. An element that is equal and varies in neither
// half has no weight: it tells no size of a difference.
//
// The halves' means are uncorrelated as far as an element's weight does not tell the sign of its
// own D. So an element that is constant within the half, which rare values make too dark, keeps the
// weight that its neighbours give it.
struct Half {
  std::size_t first = 0;  // The element that they begin with.
  // Either side's means and their squared errors, which are 0 exactly where none of its replicates
  // differs from another. A reference has neither.
  std::array<std::vector<double>, 2> mean;
  std::array<std::vector<double>, 2> variance;
  // A side with more replicates than the other has the same of as many as that, so that chance
  // treats both alike.
  std::array<std::vector<double>, 2> mean_of_fewest;
  std::array<std::vector<double>, 2> variance_of_fewest;
  std::vector<double> difference;
  std::vector<double> weight;

  // These are of as many replicates as the side with fewer has.
  double fair_mean(std::size_t side, std::size_t here) const {
    return (mean_of_fewest[side].empty() ? mean : mean_of_fewest)[side][here];
  }
  double fair_variance(std::size_t side, std::size_t here) const {
    return (variance_of_fewest[side].empty() ? variance : variance_of_fewest)[side][here];
  }

  // The squared error of the difference, without that of a reference.
  double variance_at(std::size_t here) const {
    return variance[0][here] + (variance[1].empty() ? 0 : variance[1][here]);
  }
};

// Steadying needs the variances of rows so far away.
inline constexpr std::size_t rows_beside = 2;

// Halves of the elements of these rows and of rows_beside more at either side, as far as the image
// has them. Weights are right in `rows` alone. `before` are those of rows before. What they know of
// an element is kept, and the images need not have it.
std::array<Half, halves> halves_of(const ImagePair& pair, RowRange rows,
                                   const ForEach& for_each = one_by_one,
                                   std::array<Half, halves> before = {});

}  // namespace assay::stats
