#include "stats/pyramids/image_fine_cells.h"

#include <algorithm>
#include <optional>

#include "stats/basics/vector_copies.h"
#include "stats/pyramids/image_tile.h"
#include "stats/pyramids/image_welch_cells.h"

namespace assay::stats {
namespace {

ASSAY_VECTOR_COPIES void weigh(const float* value, const float* centre, const double* weight,
                               std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = weight[i] * (static_cast<double>(value[i]) - static_cast<double>(centre[i]));
  }
}
ASSAY_VECTOR_COPIES void weigh(const float* value, const double* centre, const double* weight,
                               std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = weight[i] * (static_cast<double>(value[i]) - centre[i]);
  }
}
ASSAY_VECTOR_COPIES void weigh(const double* value, const double* centre, const double* weight,
                               std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = weight[i] * (value[i] - centre[i]);
}

// Calls fill(first element, where to) for each row of the tile that the image
// has, zeros elsewhere.
template <class Fill>
void fill_tile(const Tile& tile, std::span<double> values, const Fill& fill) {
  const ImageExtent& extent = tile.extent;
  const std::size_t stride = tile.stride();
  const std::size_t size = std::min(stride, (extent.width - tile.x) * extent.channels);
  for (std::size_t row = 0; row < tile.height() + Tile::halo; ++row) {
    const std::span<double> line = values.subspan(row * stride, stride);
    const bool there = tile.y + row < extent.height;
    if (there) {
      fill(((tile.y + row) * extent.width + tile.x) * extent.channels, line.first(size));
    }
    std::ranges::fill(line.subspan(there ? size : 0), 0.0);
  }
}

struct Updated {
  const double* sum;
  double* mean;
  double* m2;
};

ASSAY_VECTOR_COPIES void update(const Updated& row, double inverse_count, std::size_t size) {
  const double* const sum = row.sum;
  double* const __restrict mean = row.mean;
  double* const __restrict m2 = row.m2;
  for (std::size_t i = 0; i < size; ++i) {
    const double delta = sum[i] - mean[i];
    mean[i] += delta * inverse_count;
    m2[i] += delta * (sum[i] - mean[i]);
  }
}

struct ColumnSums {
  const double* row;
  double* sum;
  double* signed_sum;
};

ASSAY_VECTOR_COPIES void add_row(const ColumnSums& to, double sign, std::size_t size) {
  const double* const row = to.row;
  double* const __restrict sum = to.sum;
  double* const __restrict signed_sum = to.signed_sum;
  for (std::size_t i = 0; i < size; ++i) {
    sum[i] += row[i];
    signed_sum[i] += sign * row[i];
  }
}

// Asks for the rows of a tile before they are needed. A tile's rows are too short for the machine
// to foresee the next.
template <class Real>
void fetch_ahead(const Tile& tile, const ImageStack<Real>& stack, std::size_t image) {
  constexpr std::size_t line = 64 / sizeof(Real);
  const ImageExtent& extent = tile.extent;
  const std::size_t size = std::min(tile.stride(), (extent.width - tile.x) * extent.channels);
  const std::size_t rows = std::min(tile.height() + Tile::halo, extent.height - tile.y);
  for (std::size_t row = 0; row < rows; ++row) {
    const Real* const first =
        stack.at(image, ((tile.y + row) * extent.width + tile.x) * extent.channels);
    for (std::size_t i = 0; i < size; i += line) __builtin_prefetch(first + i);
  }
}

// The group of aligned and the group of shifted cells of one side, where there
// are any.
struct GroupsOfSide {
  std::optional<std::size_t> aligned;
  std::optional<std::size_t> shifted;
};

GroupsOfSide groups_of_side(const std::vector<WindowGroup>& groups, std::uint32_t side) {
  GroupsOfSide found;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_fine(groups[g]) || groups[g].size != side) continue;
    (groups[g].grid == Grid::aligned ? found.aligned : found.shifted) = g;
  }
  return found;
}

template <class Real>
class FineTiles {
 public:
  FineTiles(const FineCells<Real>& cells, std::size_t band, CoarseImages& coarse)
      : cells_(cells),
        extent_(cells.pair.a.extent),
        best_(cells.groups.size()),
        coarse_(coarse),
        alternating_(band * extent_.channels * alternations),
        sums_(extent_),
        column_sums_(Tile{extent_}.stride()),
        signed_column_sums_(column_sums_.size()) {
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      groups_[k] = groups_of_side(cells.groups, fine_squares[k].side);
    }
  }

  const std::vector<BestCell>& best() const { return best_; }

  void take(const Tile& tile) {
    const std::size_t size = Tile::rows * tile.stride();
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      moments_[k].start(size / (fine_squares[k].step * fine_squares[k].step));
    }
    for (std::size_t h = 0; h < halves; ++h) {
      take_half(tile, cells_.pair.a, {h, 0}, 0.5);
      if (cells_.pair.b != nullptr) take_half(tile, *cells_.pair.b, {h, 1}, -0.5);
      count_varied(tile, h);
    }
    if (!coarse_.squared_error.blocks.empty()) add_reference_error(tile);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) offer_squares(tile, k);
  }

 private:
  struct Part {
    std::size_t half;
    std::size_t side;
  };

  void take_half(const Tile& tile, const ImageStack<Real>& stack, Part part, double factor) {
    const Half& other = cells_.half[1 - part.half];
    std::vector<BlockSums>& kept = coarse_.images[part.half][part.side];
    double count = 0;
    for (std::size_t r = part.half; r < stack.images.size(); r += halves) {
      if (r + halves < stack.images.size()) fetch_ahead(tile, stack, r + halves);
      fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
        const Real* const value = stack.at(r, first);
        const double* const weight = other.weight.data() + (first - other.first);
        if (cells_.pair.b != nullptr) {
          weigh(value, cells_.pair.b->at(0, first), weight, out);
        } else {
          weigh(value, cells_.pair.reference->value.data() + first, weight, out);
        }
      });
      sums_.add_up(tile);
      const double inverse = 1 / ++count;
      for (std::size_t k = 0; k < fine_squares.size(); ++k) update_squares(tile, k, inverse);
      BlockSums& blocks = kept[r / halves];
      keep_blocks(tile, blocks);
      add_alternating(tile, blocks);
    }
    for (WelchCells& moments : moments_) moments.finish_part(count, factor);
  }

  void update_squares(const Tile& tile, std::size_t k, double inverse) {
    const std::size_t step = fine_squares[k].step;
    const std::size_t stride = tile.stride() / step;
    for (std::size_t row = 0; row < tile.height() / step; ++row) {
      update({sums_.of(k).data() + row * stride, moments_[k].mean.data() + row * stride,
              moments_[k].m2.data() + row * stride},
             inverse, tile.width() / step * extent_.channels);
    }
  }

  // Calls visit(index of the block, of its sum) for the first channel of each
  // block of the tile.
  template <class Visit>
  void for_each_block(const Tile& tile, const Visit& visit) const {
    for (std::size_t y = 0; y < tile.height() && tile.y + y < extent_.height; y += block_side) {
      for (std::size_t x = 0; x < tile.width() && tile.x + x < extent_.width; x += block_side) {
        const std::size_t row = (tile.y + y) / block_side;
        const std::size_t block = row * coarse_.extent.width + (tile.x + x) / block_side;
        visit(block * extent_.channels, y * tile.stride() + x * extent_.channels);
      }
    }
  }
  void keep_blocks(const Tile& tile, BlockSums& to) const {
    const double* const sums = sums_.of(1).data();
    for_each_block(tile, [&](std::size_t block, std::size_t sum) {
      std::copy_n(sums + sum, extent_.channels, to.blocks.data() + block);
    });
  }

  void add_alternating(const Tile& tile, BlockSums& to) {
    const std::size_t size = tile.width() * extent_.channels;
    std::fill_n(column_sums_.begin(), size, 0.0);
    std::fill_n(signed_column_sums_.begin(), size, 0.0);
    for (std::size_t y = 0; y < tile.height(); ++y) {
      add_row({sums_.values().data() + y * tile.stride(), column_sums_.data(),
               signed_column_sums_.data()},
              y % 2 == 0 ? 1 : -1, size);
    }
    for (std::size_t x = 0; x < tile.width(); ++x) {
      const double sign = x % 2 == 0 ? 1 : -1;
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        const std::size_t i = x * extent_.channels + c;
        double* const channel = to.alternating.data() + alternating_ + c * alternations;
        channel[0] += sign * column_sums_[i];
        channel[1] += signed_column_sums_[i];
        channel[2] += sign * signed_column_sums_[i];
      }
    }
  }

  // Squares of that side did not vary if none of their elements did. Their sums are then equal in
  // every replicate, to the last bit. Sums of larger cells need the count.
  void count_varied(const Tile& tile, std::size_t h) {
    fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
      const double* const weight =
          cells_.half[1 - h].weight.data() + (first - cells_.half[h].first);
      const unsigned char* const varied =
          cells_.half[h].varied.data() + (first - cells_.half[h].first);
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = weight[i] > 0 && varied[i] > 0 ? 1 : 0;
      }
    });
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.varied[h]);
  }

  // A reference's error is one for both halves, independent between elements, and known without
  // degrees of freedom. A sum that did not vary stays untested, without variance. The error says
  // nothing of values never seen.
  void add_reference_error(const Tile& tile) {
    fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        const std::size_t e = first + i;
        const std::size_t here = e - cells_.half[0].first;
        const double weight = (cells_.half[0].weight[here] + cells_.half[1].weight[here]) / 2;
        const double error = weight * cells_.pair.reference->standard_error[e];
        out[i] = error * error;
      }
    });
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.squared_error);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      std::vector<double>& variance = moments_[k].variance;
      for (std::size_t i = 0; i < variance.size(); ++i) {
        if (variance[i] > 0) variance[i] += sums_.of(k)[i];
      }
    }
  }

  void offer_squares(const Tile& tile, std::size_t k) {
    const auto [side, step] = fine_squares[k];
    const std::size_t stride = tile.stride() / step;
    for (std::size_t row = 0; row < tile.height() / step; ++row) {
      for (std::size_t column = 0; column < tile.width() / step; ++column) {
        const Rectangle square{static_cast<std::uint32_t>(tile.x + column * step),
                               static_cast<std::uint32_t>(tile.y + row * step), side, side};
        offer_square(square, k, row * stride + column * extent_.channels);
      }
    }
  }

  void offer_square(Rectangle square, std::size_t k, std::size_t first) {
    const auto width = static_cast<std::uint32_t>(extent_.width);
    const auto height = static_cast<std::uint32_t>(extent_.height);
    if (square.x >= width || square.y >= height) return;
    const bool aligned = square.x % square.width == 0 && square.y % square.height == 0;
    const std::optional<std::size_t> group = aligned ? groups_[k].aligned : groups_[k].shifted;
    if (!group) return;
    const std::uint32_t wide = std::min(square.width, width);
    const std::uint32_t high = std::min(square.height, height);
    if (!aligned && (square.x + wide > width || square.y + high > height)) return;
    square.width = std::min(wide, width - square.x);
    square.height = std::min(high, height - square.y);
    const WelchCells& moments = moments_[k];
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      if (!moments.varied(first + c)) continue;
      offer(best_[*group], {ImageStatistic::window, cells_.groups[*group].size, square, c, 0, 0, 0},
            moments.value(first + c));
    }
  }

  const FineCells<Real>& cells_;
  const ImageExtent& extent_;
  std::vector<BestCell> best_;
  CoarseImages& coarse_;
  std::size_t alternating_;  // Index of the band's sums with alternating signs.
  TileSums sums_;
  std::vector<double> column_sums_;
  std::vector<double> signed_column_sums_;
  std::array<WelchCells, fine_squares.size()> moments_;  // Squares that begin in the tile.
  std::array<GroupsOfSide, fine_squares.size()> groups_;
};

// Rows of an image are looked at in bands of tiles. Each band has alternating sums of its own until
// all are there.
constexpr std::size_t band_rows = 2 * Tile::rows;
static_assert(fine_rows % band_rows == 0 && fine_rows_ahead == Tile::halo);

}  // namespace

bool is_fine(const WindowGroup& group) {
  return group.grid != Grid::alternating &&
         std::ranges::any_of(fine_squares,
                             [&](const Squares& squares) { return squares.side == group.size; });
}

template <class Real>
CoarseImages empty_blocks(const ImagePair<Real>& pair) {
  const ImageExtent& extent = pair.a.extent;
  const std::size_t bands = (extent.height + band_rows - 1) / band_rows;
  CoarseImages coarse;
  coarse.extent = {blocks_of(extent.width), blocks_of(extent.height), extent.channels};
  const BlockSums none{std::vector<double>(coarse.extent.elements()),
                       std::vector<double>(bands * extent.channels * alternations)};
  const auto per_half = [](const ImageStack<Real>& stack, std::size_t h) {
    return (stack.images.size() + 1 - h) / halves;
  };
  for (std::size_t h = 0; h < halves; ++h) {
    coarse.images[h][0].assign(per_half(pair.a, h), none);
    if (pair.b != nullptr) coarse.images[h][1].assign(per_half(*pair.b, h), none);
    coarse.varied[h] = none;
  }
  if (pair.reference != nullptr && !pair.reference->standard_error.empty()) {
    coarse.squared_error = none;
  }
  return coarse;
}

template <class Real>
void offer_fine_cells(const FineCells<Real>& cells, RowRange rows, FineFindings& found,
                      const ForEach& for_each) {
  const ImageExtent& extent = cells.pair.a.extent;
  std::vector<std::vector<BestCell>> best((rows.last - rows.first + band_rows - 1) / band_rows);
  for_each(best.size(), [&](std::size_t i) {
    const std::size_t first = rows.first + i * band_rows;
    FineTiles<Real> tiles(cells, first / band_rows, found.coarse);
    for (std::size_t y = first; y < std::min(first + band_rows, rows.last); y += Tile::rows) {
      for (std::size_t x = 0; x < extent.width; x += Tile::columns) tiles.take({extent, x, y});
    }
    best[i] = tiles.best();
  });
  for (const std::vector<BestCell>& of_band : best) {
    for (std::size_t g = 0; g < found.best.size(); ++g) join(found.best[g], of_band[g]);
  }
}

void add_up_alternating(CoarseImages& coarse) {
  const std::size_t size = coarse.extent.channels * alternations;
  for (auto& half : coarse.images) {
    for (std::vector<BlockSums>& side : half) {
      for (BlockSums& image : side) {
        for (std::size_t i = size; i < image.alternating.size(); ++i) {
          image.alternating[i % size] += image.alternating[i];
        }
        image.alternating.resize(size);
      }
    }
  }
}

template CoarseImages empty_blocks(const ImagePair<float>&);
template CoarseImages empty_blocks(const ImagePair<double>&);
template void offer_fine_cells(const FineCells<float>&, RowRange, FineFindings&, const ForEach&);
template void offer_fine_cells(const FineCells<double>&, RowRange, FineFindings&, const ForEach&);

}  // namespace assay::stats
