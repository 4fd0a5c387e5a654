#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/for_each.h"
#include "stats/image_windows.h"

namespace assay::stats {

// Internal to cell_tails: second and third moments of the weighted sums over aligned cells, over
// the images of a stack. Sums of powers of deviations from the mean, as in Moments, with its bits.
struct CellMoments {
  double m2 = 0;
  double m3 = 0;
};

template <class Real>
struct WeightedImages {
  const ImageStack<Real>& stack;
  std::span<const double> weights;
  std::size_t step = 1;  // every step-th image, from `left_out` on, is left out
  std::optional<std::size_t> left_out = {};

  // Those that are not, in order.
  std::vector<std::size_t> taken() const;
};

// Of all windows of the groups, which are aligned, in a row, for each channel. Each sum is of
// weight (x - x of the first image). Cells of sides up to 64 tile by tile over all images, so that
// what is known of them stays in the cache; larger ones from the sums over tiles.
template <class Real>
std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<Real>& images,
                                                   const std::vector<WindowGroup>& groups,
                                                   const ForEach& for_each = one_by_one);

}  // namespace assay::stats
