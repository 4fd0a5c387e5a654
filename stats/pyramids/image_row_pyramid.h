#pragma once

#include <cstddef>
#include <vector>

#include "stats/pyramids/image_fine_cells.h"
#include "stats/pyramids/image_pyramid.h"

namespace assay::stats {

// image_pyramid for images that are read rows after rows, with the same bits. It keeps z and a
// weight for each element, and for each 4 x 4 elements one number a replicate.
template <class Real>
class RowPyramid {
 public:
  // Only the extent and the number of replicates of `pair` are read.
  RowPyramid(const ImagePair<Real>& pair, const PyramidOptions& options);

  // Takes rows that follow on those before, in multiples of row_unit but for the last. The pair
  // must have `rows_before` and `rows_ahead` more, as far as the image has.
  static constexpr std::size_t row_unit = fine_rows;
  static constexpr std::size_t rows_before = rows_beside;
  static constexpr std::size_t rows_ahead = fine_rows_ahead + rows_beside;
  void take(const ImagePair<Real>& pair, RowRange rows);

  // To be called after the last rows.
  ImageFamily family();

 private:
  void offer_cells();
  void add_best(ImageFamily& family) const;

  ImageExtent extent_;
  ForEach for_each_;
  bool constants_decide_;
  std::vector<double> own_z_;
  std::vector<WindowGroup> groups_;
  FineFindings found_;
  std::vector<BestCell> best_;  // One per group.
};

}  // namespace assay::stats
