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

std::size_t tiles_in(std::size_t count, std::size_t side) { return (count + side - 1) / side; }

template <class Real>
class Cells {
 public:
  Cells(const WeightedImages<Real>& images, const std::vector<WindowGroup>& groups)
      : images_(images),
        groups_(groups),
        extent_(images.stack.extent),
        side_(std::min(largest_tile, std::bit_ceil(std::max(extent_.width, extent_.height)))),
        tiles_{tiles_in(extent_.width, side_), tiles_in(extent_.height, side_), 1} {
    for (std::size_t size = side_; size > 0; size /= 2) levels_.emplace_back(size * size);
    for (std::size_t r = 0; r < images.stack.images.size(); ++r) {
      if (images.left_out && r % images.step == *images.left_out) continue;
      taken_.push_back(r);
    }
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

  // The channels of a tile one after the other, while it is in a cache.
  std::vector<std::vector<CellMoments>> moments() {
    for (std::size_t y = 0; y < tiles_.height; ++y) {
      for (std::size_t x = 0; x < tiles_.width; ++x) {
        for (channel_ = 0; channel_ < extent_.channels; ++channel_) take_tile(x, y);
      }
    }
    for (channel_ = 0; channel_ < extent_.channels; ++channel_) {
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (!in_tiles(groups_[g])) take_large(g);
      }
    }
    return std::move(moments_);
  }

 private:
  bool in_tiles(const WindowGroup& group) const {
    return std::has_single_bit(group.size) && group.size <= side_;
  }

  void load(std::size_t image, std::size_t left, std::size_t top) {
    std::vector<double>& values = levels_[0].sum;
    const std::span<const Real> value = images_.stack.images[image];
    const std::span<const Real> first = images_.stack.images[0];
    const std::size_t width = std::min(side_, extent_.width - left);
    for (std::size_t y = 0; y < side_ && top + y < extent_.height; ++y) {
      std::size_t e = ((top + y) * extent_.width + left) * extent_.channels + channel_;
      for (std::size_t x = 0; x < width; ++x, e += extent_.channels) {
        values[y * side_ + x] =
            images_.weights[e] * (static_cast<double>(value[e]) - static_cast<double>(first[e]));
      }
    }
  }

  void take_tile(std::size_t x, std::size_t y) {
    for (Level& level : levels_) level.clear();
    std::ranges::fill(levels_[0].sum, 0.0);  // beyond the edge it stays
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      load(taken_[i], x * side_, y * side_);
      const double count = static_cast<double>(i + 1);
      levels_[0].take(count);
      for (std::size_t k = 1; k < levels_.size(); ++k) {
        double_side(levels_[k - 1].sum.data(), levels_[k].sum.data(), side_ >> k);
        levels_[k].take(count);
      }
      tile_sums_[channel_][i][y * tiles_.width + x] = levels_.back().sum[0];
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (in_tiles(groups_[g])) keep(g, x * side_, y * side_);
    }
  }

  void keep(std::size_t g, std::size_t left, std::size_t top) {
    const std::size_t size = groups_[g].size;
    const Level& level = levels_[static_cast<std::size_t>(std::countr_zero(size))];
    const std::size_t in_row = side_ / size;
    const std::size_t row = tiles_in(extent_.width, size);
    for (std::size_t y = 0; y < in_row && top + y * size < extent_.height; ++y) {
      for (std::size_t x = 0; x < in_row && left + x * size < extent_.width; ++x) {
        const std::size_t cell = (top / size + y) * row + left / size + x;
        const std::size_t i = y * in_row + x;
        moments_[channel_][first_[g] + cell] = {static_cast<double>(taken_.size()), level.m2[i],
                                                level.m3[i]};
      }
    }
  }

  void take_large(std::size_t g) {
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
      sums.load(tile_sums_[channel_][i]);
      for (std::size_t w = 0; w < level.sum.size(); ++w) level.sum[w] = sums.of(group, w);
      level.take(static_cast<double>(i + 1));
    }
    for (std::size_t w = 0; w < level.sum.size(); ++w) {
      moments_[channel_][first_[g] + w] = {static_cast<double>(taken_.size()), level.m2[w],
                                           level.m3[w]};
    }
  }

  const WeightedImages<Real>& images_;
  const std::vector<WindowGroup>& groups_;
  const ImageExtent& extent_;
  std::size_t channel_ = 0;  // under way
  std::size_t side_;
  ImageExtent tiles_;
  std::vector<Level> levels_;                                // of sides 1, 2, 4, … of a tile
  std::vector<std::size_t> taken_;                           // images
  std::vector<std::size_t> first_;                           // window of each group
  std::vector<std::vector<std::vector<double>>> tile_sums_;  // of a channel's images
  std::vector<std::vector<CellMoments>> moments_;            // of a channel
};

}  // namespace

template <class Real>
std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<Real>& images,
                                                   const std::vector<WindowGroup>& groups) {
  return Cells<Real>(images, groups).moments();
}

template std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<float>&,
                                                            const std::vector<WindowGroup>&);
template std::vector<std::vector<CellMoments>> cell_moments(const WeightedImages<double>&,
                                                            const std::vector<WindowGroup>&);

}  // namespace assay::stats
