#pragma once

#include <cstddef>
#include <vector>

#include "stats/images/image_welch.h"
#include "stats/pyramids/image_fine_cells.h"
#include "stats/pyramids/image_pyramid.h"

namespace assay::stats {

// image_pyramid of images of which some rows are there at a time, with the same bits. What it keeps
// of each element is z, and of 4 x 4 elements a number for each replicate.
template <class Real>
class RowPyramid {
 public:
  // `pair` tells the extent and the number of replicates.
  RowPyramid(const ImagePair<Real>& pair, const PyramidOptions& options);

  // Rows that follow on those before: multiples of row_unit, but for the last. The pair must have
  // `rows_before` and `rows_ahead` more, as far as the image has.
  static constexpr std::size_t row_unit = fine_rows;
  static constexpr std::size_t rows_before = 1;
  static constexpr std::size_t rows_ahead = fine_rows_ahead + 1;
  void take(const ImagePair<Real>& pair, RowRange rows);

  // After the last rows.
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
  double best_log_p_ = 0;  // of one element
  std::vector<WindowGroup> groups_;
  FineFindings found_;
  std::vector<Energy> energy_;  // of each channel
};

}  // namespace assay::stats
