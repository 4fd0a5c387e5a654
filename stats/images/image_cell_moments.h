#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_windows.h"

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
  std::size_t first_weight = 0;  // element that the weights begin with
  std::size_t step = 1;          // every step-th image, from `left_out` on, is left out
  std::optional<std::size_t> left_out = {};

  // Those that are not, in order.
  std::vector<std::size_t> taken() const;
};

// Moments of each channel: of windows of several groups in a row.
using ChannelMoments = std::vector<std::vector<CellMoments>>;

// Sums over the windows of aligned groups, each of weight (x - x of the first image), rows of the
// image after rows. Cells of sides up to 64 tile by tile over all images, so that what is known of
// them stays in the cache; larger ones, after the last rows, from the sums over tiles.
class RowCellMoments {
 public:
  RowCellMoments(const ImageExtent& extent, std::vector<WindowGroup> groups);

  // Rows are taken in multiples of so many, but for the image's last.
  static constexpr std::size_t row_unit = 64;

  // Of the cells in these rows, those of one group after the other's. All calls name as many
  // images.
  template <class Real>
  ChannelMoments take(const WeightedImages<Real>& images, RowRange rows,
                      const ForEach& for_each = one_by_one);
  // Of all cells that are larger, likewise.
  ChannelMoments larger(const ForEach& for_each = one_by_one) const;

  bool is_larger(const WindowGroup& group) const;
  // How many of a group's cells that are not larger begin in these rows.
  std::size_t cells_in(const WindowGroup& group, RowRange rows) const;
  // The sums of numbers of one channel over the larger cells, from those over tiles.
  std::vector<double> larger_sums(const std::vector<double>& of_tiles) const;
  const ImageExtent& tiles() const { return tiles_; }
  std::size_t images() const { return tile_sums_[0].size(); }  // of the last call
  std::size_t tile_side() const { return side_; }

 private:
  ImageExtent extent_;
  std::vector<WindowGroup> groups_;
  std::size_t side_;
  ImageExtent tiles_;
  std::vector<std::vector<std::vector<double>>> tile_sums_;  // of a channel's images
  std::vector<WindowGroup> larger_;                          // groups, in tiles
};

}  // namespace assay::stats
