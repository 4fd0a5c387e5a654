#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_windows.h"

namespace assay::stats {

// Internal to cell_tails: sums of second and third powers of deviations from the mean, over the
// images of a stack. The values are weighted sums over aligned cells. The bits are those of
// Moments.
struct CellMoments {
  double m2 = 0;
  double m3 = 0;
};

template <class Real>
struct WeightedImages {
  const ImageStack<Real>& stack;
  std::span<const double> weights;
  std::size_t first_weight = 0;  // The element that the weights begin with.
  std::size_t step = 1;          // Every step-th image, from `left_out` on, is left out.
  std::optional<std::size_t> left_out = {};

  // Indices of the images that are not left out, in order.
  std::vector<std::size_t> taken() const;
};

// Moments of each channel, for the windows of several groups in a row.
using ChannelMoments = std::vector<std::vector<CellMoments>>;

// Sums of weight (x - x of the first image) over the windows of aligned groups, taken rows after
// rows. Cells of sides up to 64 are summed tile by tile over all images, which keeps them in the
// cache. Larger ones come from the sums over tiles, after the last rows.
class RowCellMoments {
 public:
  RowCellMoments(const ImageExtent& extent, std::vector<WindowGroup> groups);

  // Rows are taken in multiples of this number, but for the image's last.
  static constexpr std::size_t row_unit = 64;

  // Moments of the cells in these rows, group after group. All calls name as many images.
  template <class Real>
  ChannelMoments take(const WeightedImages<Real>& images, RowRange rows,
                      const ForEach& for_each = one_by_one);
  // Moments of all larger cells, likewise.
  ChannelMoments larger(const ForEach& for_each = one_by_one) const;

  bool is_larger(const WindowGroup& group) const;
  // Number of a group's smaller cells that begin in these rows.
  std::size_t cells_in(const WindowGroup& group, RowRange rows) const;
  // The sums of one channel's numbers over the larger cells, from those over tiles.
  std::vector<double> larger_sums(const std::vector<double>& of_tiles) const;
  const ImageExtent& tiles() const { return tiles_; }
  std::size_t images() const { return tile_sums_[0].size(); }
  std::size_t tile_side() const { return side_; }

 private:
  ImageExtent extent_;
  std::vector<WindowGroup> groups_;
  std::size_t side_;
  ImageExtent tiles_;
  std::vector<std::vector<std::vector<double>>> tile_sums_;  // Per channel and image.
  std::vector<WindowGroup> larger_;                          // Groups, in tiles.
};

}  // namespace assay::stats
