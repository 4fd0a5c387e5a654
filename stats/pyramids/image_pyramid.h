#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"
#include "stats/pyramids/image_cells.h"

namespace assay::stats {

// Are two images equal? Their difference is looked at on every scale at once. Cells have one
// element to the whole image; one more sum has alternating signs. A family p-value covers all of it
// (image_family.h).
//
// Replicates of two images, or of one against a reference. Null hypothesis: E a = E b at every
// element. Asymptotic (Welch's law).
//
// The replicates are dealt to two halves. Each half gives the other its weights w ~ 1 /
// sqrt(va + vb), from variances steadied by those of 5 x 5 neighbours. A constant element has
// weight 0. A replicate's cell value is its weighted mean. T is the Welch statistic of the cell
// values over replicates, averaged over the halves. Weights and values are independent, so the
// numerator has mean zero for any law of the elements. Of one element T is Welch's. Correlation
// between elements is in the variance. Adding up the elements' own z would fail at both
// (measurements.md).
//
// Rare bright values (fireflies) make T too large where one image has them and missed them. So a
// cell's T is only as large as its neighbours allow (image_noise.h). What no replicate of the whole
// image shows, no test knows.
//
// The span `z` receives T of every element by its own noise as a normal z, if it has room. Bands of
// the images may be looked at at the same time (`for_each`).
//
// An element that never varied has no weight unless it differs. Then it is in sums if its
// neighbours vary. With `constants_decide` it is also tested by itself (log_p_constants). Where an
// element within 8 of its tile of 64 x 32 has other values beside this one, it may have missed
// values as large as that tile's. Else it has missed none, and the difference is certain. `unseen`
// has elements that were tested before.
//
// Throws std::domain_error for unequal extents, fewer than least_replicates images, values that are
// not finite, and a negative standard error of a reference.
struct PyramidOptions {
  std::span<double> z = {};
  ForEach for_each = one_by_one;
  bool constants_decide = true;
  std::vector<UnseenElement> unseen = {};
};

// image_pyramid for images that are read rows after rows, with the same bits. It keeps z and a
// weight for each element, and for each 4 x 4 elements one number a replicate.
class RowPyramid {
 public:
  // Only the extent and the number of replicates of `pair` are read.
  RowPyramid(const ImagePair& pair, const PyramidOptions& options);

  // Takes rows that follow on those before, in multiples of row_unit but for the last. The pair
  // must have `rows_ahead` more, as far as the image has.
  static constexpr std::size_t row_unit = fine_rows;
  static constexpr std::size_t rows_ahead = fine_rows_ahead + rows_beside;
  void take(const ImagePair& pair, RowRange rows);

  // To be called after the last rows.
  ImageFamily family();

 private:
  std::vector<CellNoiseOfMean> offer_cells();  // Answers those of TypicalCell.
  void add_best(ImageFamily& family) const;

  ImageExtent extent_;
  ForEach for_each_;
  bool constants_decide_;
  std::vector<UnseenElement> unseen_;
  std::vector<double> own_z_;
  std::vector<WindowGroup> groups_;
  std::array<Half, halves> half_;  // They are of the rows taken last.
  FineFindings found_;
  std::vector<BestCell> best_;  // One per group.
};

ImageFamily image_pyramid(const ImagePair& pair, const PyramidOptions& options = {});

}  // namespace assay::stats
