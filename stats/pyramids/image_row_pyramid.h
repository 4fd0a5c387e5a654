#pragma once

#include <cstddef>
#include <vector>

#include "stats/images/image_welch.h"
#include "stats/pyramids/image_fine_cells.h"
#include "stats/pyramids/image_pyramid.h"

namespace assay::stats {

// image_pyramid for images that are read rows after rows, with the same bits. It keeps z for each
// element, and for each 4 x 4 elements one number a replicate.
template <class Real>
class RowPyramid {
 public:
  // Only the extent and the number of replicates of `pair` are read.
  RowPyramid(const ImagePair<Real>& pair, const PyramidOptions& options);

  // Takes rows that follow on those before, in multiples of row_unit but for the last. The pair
  // must have `rows_before` and `rows_ahead` more, as far as the image has.
  static constexpr std::size_t row_unit = fine_rows;
  static constexpr std::size_t rows_before = 1;
  static constexpr std::size_t rows_ahead = fine_rows_ahead + 1;
  void take(const ImagePair<Real>& pair, RowRange rows);

  // To be called after the last rows.
  ImageFamily family();

 private:
  struct Energy {
    double sum = 0;
    double squares = 0;
  };

  void take_elements(const ImagePair<Real>& pair, RowRange rows);
  void leave_to_sums(ElementRange range);
  void take_cells(const ImagePair<Real>& pair, RowRange rows);
  void add_elements(ImageFamily& family) const;
  void add_best_windows(ImageFamily& family) const;
  void add_best_energy(ImageFamily& family) const;

  ImageExtent extent_;
  PyramidOptions options_;
  std::vector<double> own_z_;
  std::span<double> z_;
  WelchCounts counts_;
  std::size_t best_element_ = 0;
  double best_log_p_ = 0;  // The smallest so far, for one element.
  std::vector<WindowGroup> groups_;
  FineFindings found_;
  std::vector<Energy> energy_;
};

}  // namespace assay::stats
