#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image_halves.h"
#include "stats/images/image_windows.h"
#include "stats/pyramids/image_best_cell.h"

namespace assay::stats {

// Internal to image_pyramid. Nearly all cells are small, and an image has many
// replicates: cells of sides 2, 4 and 8 are tested tile by tile, each tile over
// all replicates while what is known of its cells stays in the cache. Sums of
// larger cells are taken from those of blocks of 4 x 4, which are left behind.

inline constexpr std::size_t sides_of_pair = 2;  // a and b
inline constexpr std::size_t alternations = 3;   // by column, by row, checkerboard
inline constexpr std::uint32_t block_side = 4;
// That cover so many elements of a row or column.
inline std::size_t blocks_of(std::size_t count) { return (count + block_side - 1) / block_side; }

// The smallest size that is not, but for a whole image.
inline constexpr std::uint32_t coarse_size = 16;
// Whether the cells of a group are tested here.
bool is_fine(const WindowGroup& group);

// One image's weighted sums over blocks of 4 x 4 elements, the last ones cut
// off at the edge, and those with alternating signs over all of it,
// `alternations` a channel.
struct BlockSums {
  std::vector<double> blocks;
  std::vector<double> alternating;
};

struct CoarseImages {
  ImageExtent extent;  // in blocks
  // [half][side][replicate of the half]
  std::array<std::array<std::vector<BlockSums>, sides_of_pair>, halves> images;
  std::array<BlockSums, halves> varied;  // how many elements vary and have a weight
  BlockSums squared_error;               // of a reference, weighted; empty where it has none
};

// What fine cells are tested on: the replicates, their halves with the weights
// that each gives the other, and the groups of cells.
template <class Real>
struct FineCells {
  const ImagePair<Real>& pair;
  const std::array<Half, halves>& half;
  const std::vector<WindowGroup>& groups;
};

struct FineFindings {
  CoarseImages coarse;
  std::vector<BestCell> best;  // by group
};

template <class Real>
CoarseImages empty_blocks(const ImagePair<Real>& pair);

// Rows are taken in multiples of so many, but for the image's last. Cells that begin in them reach
// into so many rows more, which the images and the halves must have.
inline constexpr std::size_t fine_rows = 64;
inline constexpr std::size_t fine_rows_ahead = 8;

// Offers every fine cell that begins in these rows to the best of its group, and fills in their
// blocks.
template <class Real>
void offer_fine_cells(const FineCells<Real>& cells, RowRange rows, FineFindings& found,
                      const ForEach& for_each = one_by_one);

// After the last rows.
void add_up_alternating(CoarseImages& coarse);

}  // namespace assay::stats
