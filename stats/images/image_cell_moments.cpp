#include "stats/images/image_cell_moments.h"

#include <algorithm>
#include <bit>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t largest_tile = 64;

struct Row {
  const double* sum;
  double* mean;
  double* m2;
  double* m3;
};

// Moments::add without its fourth order.
ASSAY_VECTOR_COPIES void update(const Row& row, double count, std::size_t size) {
  const double* const sum = row.sum;
  double* const __restrict mean = row.mean;
  double* const __restrict m2 = row.m2;
  double* const __restrict m3 = row.m3;
  const double before = count - 1;
  const double inverse = 1 / count;
  for (std::size_t i = 0; i < size; ++i) {
    const double delta = sum[i] - mean[i];
    const double step = delta * inverse;
    const double term = delta * step * before;
    m3[i] += term * step * (count - 2) - 3 * step * m2[i];
    m2[i] += term;
    mean[i] += step;
  }
}

struct Level {
  std::vector<double> sum;
  std::vector<double> mean;
  std::vector<double> m2;
  std::vector<double> m3;

  explicit Level(std::size_t size) : sum(size), mean(size), m2(size), m3(size) {}
  void take(double count) {
    update({sum.data(), mean.data(), m2.data(), m3.data()}, count, sum.size());
  }
};

// Squares of twice the side, `side` of them in a row.
ASSAY_VECTOR_COPIES void double_side(const double* from, double* to, std::size_t side) {
  double* const __restrict sum = to;
  for (std::size_t y = 0; y < side; ++y) {
    const double* const top = from + 4 * y * side;
    const double* const bottom = top + 2 * side;
    for (std::size_t x = 0; x < side; ++x) {
      sum[y * side + x] = (top[2 * x] + top[2 * x + 1]) + (bottom[2 * x] + bottom[2 * x + 1]);
    }
  }
}

// The part of one image in a row: weight (x - x of the first image).
struct WeighedRow {
  const double* weight;
  double* out;
};
template <class Real>
inline void weigh_row(const Real* value, const Real* first, const WeighedRow& row,
                      std::size_t size) {
  double* const __restrict out = row.out;
  for (std::size_t i = 0; i < size; ++i) {
    out[i] = row.weight[i] * (static_cast<double>(value[i]) - static_cast<double>(first[i]));
  }
}
ASSAY_VECTOR_COPIES void weigh(const float* value, const float* first, const WeighedRow& row,
                               std::size_t size) {
  weigh_row(value, first, row, size);
}
ASSAY_VECTOR_COPIES void weigh(const double* value, const double* first, const WeighedRow& row,
                               std::size_t size) {
  weigh_row(value, first, row, size);
}

// Three channels side by side to three rows.
struct ThreeRows {
  double* first;
  double* second;
  double* third;
};
ASSAY_VECTOR_COPIES void part(const double* from, const ThreeRows& to, std::size_t size) {
  double* const __restrict first = to.first;
  double* const __restrict second = to.second;
  double* const __restrict third = to.third;
  for (std::size_t x = 0; x < size; ++x) {
    first[x] = from[3 * x];
    second[x] = from[3 * x + 1];
    third[x] = from[3 * x + 2];
  }
}

std::size_t tiles_in(std::size_t count, std::size_t side) { return (count + side - 1) / side; }

// A tile's sums and moments. Sums stay 0 beyond the edge. Each channel has moments of sides 1, 2,
// 4, … up to its own.
class TileLevels {
 public:
  TileLevels(std::size_t side, std::size_t channels) : side_(side), row_(side * channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<Level>& levels = channels_.emplace_back();
      for (std::size_t size = side; size > 0; size /= 2) levels.emplace_back(size * size);
    }
  }

  // Row y of an image's tile. The caller puts numbers here, channels side by side, and they are
  // then taken.
  double* row() { return row_.data(); }
  void take_row(std::size_t y, std::size_t width) {
    const auto to = [&](std::size_t c) { return channels_[c][0].sum.data() + y * side_; };
    const std::size_t count = channels_.size();
    if (count == 3) {
      part(row_.data(), {to(0), to(1), to(2)}, width);
      return;
    }
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t x = 0; x < width; ++x) to(c)[x] = row_[x * count + c];
    }
  }
  void take_image(double count) {
    for (std::vector<Level>& levels : channels_) {
      levels[0].take(count);
      for (std::size_t k = 1; k < levels.size(); ++k) {
        double_side(levels[k - 1].sum.data(), levels[k].sum.data(), side_ >> k);
        levels[k].take(count);
      }
    }
  }
  double sum(std::size_t channel) const { return channels_[channel].back().sum[0]; }
  const Level& of_side(std::size_t channel, std::size_t size) const {
    return channels_[channel][static_cast<std::size_t>(std::countr_zero(size))];
  }

 private:
  std::size_t side_;
  std::vector<double> row_;
  std::vector<std::vector<Level>> channels_;
};

// The cells of a band of tiles, and the sums over its tiles.
template <class Real>
class Band {
 public:
  Band(const WeightedImages<Real>& images, const ImageExtent& tiles, std::size_t side)
      : images_(images), extent_(images.stack.extent), tiles_(tiles), side_(side) {}

  // Destination of a channel's cells of one size that begin in the band's rows.
  struct Cells {
    std::size_t size;
    std::size_t first;  // Index in the channel's moments.
    std::size_t row;    // The row of cells that the first is in.
  };

  void take_tile(std::size_t x, std::size_t y, std::span<const std::size_t> taken,
                 std::vector<std::vector<std::vector<double>>>& tile_sums) {
    for (std::size_t i = 0; i < taken.size(); ++i) {
      load(taken[i], x * side_, y * side_);
      levels_.take_image(static_cast<double>(i + 1));
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        tile_sums[c][i][y * tiles_.width + x] = levels_.sum(c);
      }
    }
  }

  void keep(const Cells& cells, std::size_t left, std::size_t top, ChannelMoments& to) const {
    const std::size_t in_row = side_ / cells.size;
    const std::size_t row = tiles_in(extent_.width, cells.size);
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      const Level& level = levels_.of_side(c, cells.size);
      for (std::size_t y = 0; y < in_row && top + y * cells.size < extent_.height; ++y) {
        for (std::size_t x = 0; x < in_row && left + x * cells.size < extent_.width; ++x) {
          const std::size_t cell = (top / cells.size + y - cells.row) * row + left / cells.size + x;
          const std::size_t i = y * in_row + x;
          to[c][cells.first + cell] = {level.m2[i], level.m3[i]};
        }
      }
    }
  }

 private:
  void load(std::size_t image, std::size_t left, std::size_t top) {
    const std::size_t width = std::min(side_, extent_.width - left);
    for (std::size_t y = 0; y < side_ && top + y < extent_.height; ++y) {
      const std::size_t e = ((top + y) * extent_.width + left) * extent_.channels;
      weigh(images_.stack.at(image, e), images_.stack.at(0, e),
            {images_.weights.data() + (e - images_.first_weight), levels_.row()},
            width * extent_.channels);
      levels_.take_row(y, width);
    }
  }

  const WeightedImages<Real>& images_;
  const ImageExtent& extent_;
  const ImageExtent& tiles_;
  std::size_t side_;
  TileLevels levels_{side_, extent_.channels};
};

WindowGroup in_tiles(WindowGroup group, std::size_t side) {
  for (Rectangle& window : group.windows) {
    const auto tiles = [&](std::uint32_t end) {
      return static_cast<std::uint32_t>(tiles_in(end, side));
    };
    const std::uint32_t x = tiles(window.x);
    const std::uint32_t y = tiles(window.y);
    window = {x, y, tiles(window.x + window.width) - x, tiles(window.y + window.height) - y};
  }
  return group;
}

}  // namespace

template <class Real>
std::vector<std::size_t> WeightedImages<Real>::taken() const {
  std::vector<std::size_t> taken;
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    if (!left_out || r % step != *left_out) taken.push_back(r);
  }
  return taken;
}

RowCellMoments::RowCellMoments(const ImageExtent& extent, std::vector<WindowGroup> groups)
    : extent_(extent),
      groups_(std::move(groups)),
      side_(std::min(row_unit, std::bit_ceil(std::max(extent.width, extent.height)))),
      tiles_{tiles_in(extent.width, side_), tiles_in(extent.height, side_), 1},
      tile_sums_(extent.channels) {
  for (const WindowGroup& group : groups_) {
    if (is_larger(group)) larger_.push_back(in_tiles(group, side_));
  }
}

bool RowCellMoments::is_larger(const WindowGroup& group) const {
  return !std::has_single_bit(group.size) || group.size > side_;
}

std::size_t RowCellMoments::cells_in(const WindowGroup& group, RowRange rows) const {
  const std::size_t lines = tiles_in(rows.last, group.size) - rows.first / group.size;
  return lines * tiles_in(extent_.width, group.size);
}

template <class Real>
ChannelMoments RowCellMoments::take(const WeightedImages<Real>& images, RowRange rows,
                                    const ForEach& for_each) {
  const std::vector<std::size_t> taken = images.taken();
  for (auto& of_channel : tile_sums_) {
    of_channel.resize(taken.size(), std::vector<double>(tiles_.elements()));
  }
  std::vector<typename Band<Real>::Cells> cells;
  std::size_t count = 0;
  for (const WindowGroup& group : groups_) {
    if (is_larger(group)) continue;
    cells.push_back({group.size, count, rows.first / group.size});
    count += cells_in(group, rows);
  }
  ChannelMoments moments(extent_.channels, std::vector<CellMoments>(count));
  const std::size_t bands = tiles_in(rows.last, side_) - rows.first / side_;
  for_each(bands * tiles_.width, [&](std::size_t i) {
    const std::size_t x = i % tiles_.width;
    const std::size_t y = rows.first / side_ + i / tiles_.width;
    Band<Real> band(images, tiles_, side_);
    band.take_tile(x, y, taken, tile_sums_);
    for (const auto& each : cells) band.keep(each, x * side_, y * side_, moments);
  });
  return moments;
}

std::vector<double> RowCellMoments::larger_sums(const std::vector<double>& of_tiles) const {
  WindowSums sums(tiles_);
  sums.load(of_tiles);
  std::vector<double> of_cells;
  for (const WindowGroup& group : larger_) {
    for (std::size_t w = 0; w < group.windows.size(); ++w) of_cells.push_back(sums.of(group, w));
  }
  return of_cells;
}

ChannelMoments RowCellMoments::larger(const ForEach& for_each) const {
  ChannelMoments moments(extent_.channels);
  for_each(extent_.channels, [&](std::size_t channel) {
    Level level(0);
    double count = 0;
    for (const std::vector<double>& of_tiles : tile_sums_[channel]) {
      std::vector<double> sums = larger_sums(of_tiles);
      if (count == 0) level = Level(sums.size());
      level.sum = std::move(sums);
      level.take(++count);
    }
    for (std::size_t w = 0; w < level.sum.size(); ++w) {
      moments[channel].push_back({level.m2[w], level.m3[w]});
    }
  });
  return moments;
}

template struct WeightedImages<float>;
template struct WeightedImages<double>;
template ChannelMoments RowCellMoments::take(const WeightedImages<float>&, RowRange,
                                             const ForEach&);
template ChannelMoments RowCellMoments::take(const WeightedImages<double>&, RowRange,
                                             const ForEach&);

}  // namespace assay::stats
