#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/images/image.h"

namespace assay::stats {

// Internal to image_fine_cells: a tile of an image, and the sums over the squares that begin in it.
// All channels stand side by side as in the image. Everything beyond the image's edge is zero, so a
// cell cut off by the edge is a whole square here.
struct Tile {
  static constexpr std::size_t rows = 16;
  static constexpr std::size_t columns = 128;
  static constexpr std::size_t halo = 8;  // Rows and columns beyond, into which its squares reach.

  ImageExtent extent;
  std::size_t x = 0;
  std::size_t y = 0;

  // Columns and rows that begin here, in multiples of 8.
  std::size_t width() const;
  std::size_t height() const;
  // Distance from one row of values to the next.
  std::size_t stride() const { return (columns + halo) * extent.channels; }
};

// Sides of the squares, and distance from one square to the next.
struct Squares {
  std::uint32_t side;
  std::uint32_t step;
};
inline constexpr std::array<Squares, 3> fine_squares{{{2, 1}, {4, 1}, {8, 2}}};

class TileSums {
 public:
  explicit TileSums(const ImageExtent& extent);

  // Rows of Tile::stride() values, Tile::height() + halo of them. The caller fills them.
  std::span<double> values() { return values_; }
  void add_up(const Tile& tile);

  // Sums by index in fine_squares, row after row of Tile::stride() / step.
  const std::vector<double>& of(std::size_t squares) const { return sums_[squares]; }

 private:
  std::size_t channels_;
  std::vector<double> values_;
  std::vector<double> blocks_;  // Blocks of 2 x 2, at even columns and rows.
  std::vector<double> fours_;   // Blocks of 2 x 2 of these, at each of them.
  std::array<std::vector<double>, fine_squares.size()> sums_;
};

}  // namespace assay::stats
