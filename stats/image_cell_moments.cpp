#include "stats/image_cell_moments.h"

#include <algorithm>
#include <bit>

#include "stats/vector_copies.h"

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

// Sums and moments of a row of numbers.
struct Level {
  std::vector<double> sum;
  std::vector<double> mean;
  std::vector<double> m2;
  std::vector<double> m3;

  explicit Level(std::size_t size) : sum(size), mean(size), m2(size), m3(size) {}
  void clear() {
    for (std::vector<double>* each : {&mean, &m2, &m3}) std::ranges::fill(*each, 0.0);
  }
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

// What one image adds to a row: weight (x - x of the first image).
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

// A tile's sums and moments: of each channel those of sides 1, 2, 4, … up to its own.
class TileLevels {
 public:
  TileLevels(std::size_t side, std::size_t channels) : side_(side), row_(side * channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<Level>& levels = channels_.emplace_back();
      for (std::size_t size = side; size > 0; size /= 2) levels.emplace_back(size * size);
    }
  }

  void clear() {
    for (std::vector<Level>& levels : channels_) {
      for (Level& level : levels) level.clear();
      std::ranges::fill(levels[0].sum, 0.0);  // beyond the edge it stays
    }
  }
  // Row y of an image's tile: where its numbers are to be put, channels side by side, and then
  // taken from.
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
  // The rows of one more image.
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

template <class Real>
class Cells {
 public:
  Cells(const WeightedImages<Real>& images, const std::vector<WindowGroup>& groups)
      : images_(images),
        groups_(groups),
        extent_(images.stack.extent),
        side_(std::min(largest_tile, std::bit_ceil(std::max(extent_.width, extent_.height)))),
        tiles_{tiles_in(extent_.width, side_), tiles_in(extent_.height, side_), 1},
        taken_(images.taken()) {
    const std::vector<std::vector<double>> sums(taken_.size(),
                                                std::vector<double>(tiles_.elements()));
    tile_sums_.assign(extent_.channels, sums);
    std::size_t count = 0;
    for (const WindowGroup& group : groups) {
      first_.push_back(count);
      count += group.windows.size();
    }
    moments_.assign(extent_.channels, std::vector<CellMoments>(count));
  }

  // A row of tiles after the other, or several at a time.
  std::vector<std::vector<CellMoments>> moments(const ForEach& for_each) {
    for_each(tiles_.height, [&](std::size_t y) {
      TileLevels levels(side_, extent_.channels);
      for (std::size_t x = 0; x < tiles_.width; ++x) take_tile(x, y, levels);
    });
    for_each(extent_.channels, [&](std::size_t channel) {
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (!in_tiles(groups_[g])) take_large(g, channel);
      }
    });
    return std::move(moments_);
  }

 private:
  bool in_tiles(const WindowGroup& group) const {
    return std::has_single_bit(group.size) && group.size <= side_;
  }

  void load(std::size_t image, std::size_t left, std::size_t top, TileLevels& levels) const {
    const Real* const value = images_.stack.images[image].data();
    const Real* const first = images_.stack.images[0].data();
    const std::size_t width = std::min(side_, extent_.width - left);
    for (std::size_t y = 0; y < side_ && top + y < extent_.height; ++y) {
      const std::size_t e = ((top + y) * extent_.width + left) * extent_.channels;
      weigh(value + e, first + e, {images_.weights.data() + e, levels.row()},
            width * extent_.channels);
      levels.take_row(y, width);
    }
  }

  void take_tile(std::size_t x, std::size_t y, TileLevels& levels) {
    levels.clear();
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      load(taken_[i], x * side_, y * side_, levels);
      levels.take_image(static_cast<double>(i + 1));
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        tile_sums_[c][i][y * tiles_.width + x] = levels.sum(c);
      }
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!in_tiles(groups_[g])) continue;
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        keep(g, x * side_, y * side_, levels.of_side(c, groups_[g].size), moments_[c]);
      }
    }
  }

  void keep(std::size_t g, std::size_t left, std::size_t top, const Level& level,
            std::vector<CellMoments>& moments) const {
    const std::size_t size = groups_[g].size;
    const std::size_t in_row = side_ / size;
    const std::size_t row = tiles_in(extent_.width, size);
    for (std::size_t y = 0; y < in_row && top + y * size < extent_.height; ++y) {
      for (std::size_t x = 0; x < in_row && left + x * size < extent_.width; ++x) {
        const std::size_t cell = (top / size + y) * row + left / size + x;
        const std::size_t i = y * in_row + x;
        moments[first_[g] + cell] = {level.m2[i], level.m3[i]};
      }
    }
  }

  void take_large(std::size_t g, std::size_t channel) {
    WindowGroup group = groups_[g];
    for (Rectangle& window : group.windows) {
      const auto in_tiles = [&](std::uint32_t end) {
        return static_cast<std::uint32_t>(tiles_in(end, side_));
      };
      const std::uint32_t x = in_tiles(window.x);
      const std::uint32_t y = in_tiles(window.y);
      window = {x, y, in_tiles(window.x + window.width) - x,
                in_tiles(window.y + window.height) - y};
    }
    WindowSums sums(tiles_);
    Level level(group.windows.size());
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      sums.load(tile_sums_[channel][i]);
      for (std::size_t w = 0; w < level.sum.size(); ++w) level.sum[w] = sums.of(group, w);
      level.take(static_cast<double>(i + 1));
    }
    for (std::size_t w = 0; w < level.sum.size(); ++w) {
      moments_[channel][first_[g] + w] = {level.m2[w], level.m3[w]};
    }
  }

  const WeightedImages<Real>& images_;
  const std::vector<WindowGroup>& groups_;
  const ImageExtent& extent_;
  std::size_t side_;
  ImageExtent tiles_;
  std::vector<std::size_t> taken_;                           // images
  std::vector<std::size_t> first_;                           // window of each group
  std::vector<std::vector<std::vector<double>>> tile_sums_;  // of a channel's images
  std::vector<std::vector<CellMoments>> moments_;            // of a channel
};

}  // namespace

template <class Real>
std::vector<std::size_t> WeightedImages<Real>::taken() const {
  std::vector<std::size_t> taken;
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    if (!left_out || r % step != *left_out) taken.push_back(r);
  }
  return taken;
}

template <class Real>
std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<Real>& images,
                                                   const std::vector<WindowGroup>& groups,
                                                   const ForEach& for_each) {
  return Cells<Real>(images, groups).moments(for_each);
}

template struct WeightedImages<float>;
template struct WeightedImages<double>;
template std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<float>&,
                                                            const std::vector<WindowGroup>&,
                                                            const ForEach&);
template std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<double>&,
                                                            const std::vector<WindowGroup>&,
                                                            const ForEach&);

}  // namespace assay::stats
