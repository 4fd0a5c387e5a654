#include <algorithm>

#include "stats/pyramids/image_cells.h"

namespace assay::stats {
namespace {

using Groups = std::vector<WindowGroup>;

// Cells of groups that are not fine, as rectangles of blocks
// (image_cells.h), all channels and images alike.
Groups coarse_groups(const Groups& groups) {
  Groups coarse = groups;
  const auto blocks = [](std::uint32_t end) { return static_cast<std::uint32_t>(blocks_of(end)); };
  for (WindowGroup& group : coarse) {
    if (is_fine(group) || group.size == 1) group.windows.clear();
    for (Rectangle& window : group.windows) {
      const std::uint32_t x = window.x / block_side;
      const std::uint32_t y = window.y / block_side;
      window = {x, y, blocks(window.x + window.width) - x, blocks(window.y + window.height) - y};
    }
  }
  return coarse;
}

template <class Visit>
void for_each_window(const Groups& groups, const Visit& visit) {
  std::size_t window = 0;
  for (const WindowGroup& group : groups) {
    for (std::size_t i = 0; i < group.windows.size(); ++i) visit(group, i, window++);
  }
}

class CoarseSums {
 public:
  CoarseSums(const ImageExtent& extent, std::size_t channel)
      : channels_(extent.channels),
        channel_(channel),
        sums_(extent),
        values_(extent.width * extent.height) {}

  template <class Number>
  void load(const BlockSums<Number>& image) {
    alternating_ = image.alternating.data() + channel_ * alternations;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = static_cast<double>(image.blocks[i * channels_ + channel_]);
    }
    sums_.load(values_);
  }
  double of(const WindowGroup& group, std::size_t index) const {
    return group.grid == Grid::alternating ? alternating_[index] : sums_.of(group.windows[index]);
  }
  // Its sum of numbers of one sign, term by term: differences of table entries would lose a small
  // one beside large ones.
  double direct_of(const Rectangle& window, std::size_t width) const {
    double sum = 0;
    for (std::size_t y = window.y; y < window.y + window.height; ++y) {
      for (std::size_t x = window.x; x < window.x + window.width; ++x)
        sum += values_[y * width + x];
    }
    return sum;
  }
  // Sum over all elements in the window, also for those that alternate.
  double total_of(const WindowGroup& group, std::size_t index) const {
    return group.grid == Grid::alternating ? sums_.of_all() : sums_.of(group.windows[index]);
  }

 private:
  std::size_t channels_;
  std::size_t channel_;
  WindowSums sums_;
  std::vector<double> values_;
  const double* alternating_ = nullptr;
};

// Moments of one channel's windows, all groups in a row.
WelchCells window_moments(const CoarseImages& coarse, const Groups& groups, std::size_t channel) {
  std::size_t count = 0;
  for (const WindowGroup& group : groups) count += group.windows.size();
  WelchCells moments;
  moments.start(count);
  CoarseSums sums(coarse.extent, channel);
  // Adds a half's sums, divided by those of its weights to this power.
  const auto add = [&](std::vector<double>& to, const BlockSums<double>& half, int power) {
    sums.load(half);
    for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
      moments.add(to, window, {{sums.of(group, i)}}, power);
    });
  };
  for (std::size_t h = 0; h < halves; ++h) {
    const CoarseHalf& half = coarse.half[h];
    sums.load(half.weights);
    for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
      const double weights = group.grid == Grid::alternating
                                 ? sums.total_of(group, i)
                                 : sums.direct_of(group.windows[i], coarse.extent.width);
      moments.start_half(window, {{weights}});
    });
    add(moments.effect, half.effect, 1);
    add(moments.third, half.third, 3);
    const bool of_two = !half.images[1].empty();
    sums.load(half.squared_weights);
    for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
      const double squares = of_two ? sums.of(group, i) : sums.total_of(group, i);
      moments.add(moments.concentration, window, {{squares}}, 2);
    });
    for (std::size_t side = 0; side < sides_of_pair; ++side) {
      const std::vector<BlockSums<float>>& images = half.images[side];
      if (images.empty()) continue;
      for (const BlockSums<float>& image : images) {
        sums.load(image);
        for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
          const double deviation = sums.of(group, i);
          moments.squares[window] += deviation * deviation;
        });
      }
      sums.load(half.varied);
      for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
        // The sum did not vary. The value is only the rounding of the larger sums it was taken
        // from.
        if (sums.total_of(group, i) == 0) moments.squares[window] = 0;
      });
      moments.finish_part(h, side, static_cast<double>(images.size()));
    }
    if (half.squared_error.blocks.empty()) continue;
    sums.load(half.squared_error);
    for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
      moments.add(moments.variance[1], window, {{std::max(sums.total_of(group, i), 0.0)}}, 2);
    });
  }
  return moments;
}

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

class TypicalNoise {
 public:
  void add(const Candidate& cell, const NoisePyramid& noise) {
    static_assert(typical_side >= coarse_size);
    const auto growth = [&](double sign) {
      return noise.growth(cell.noise, sign, cell.finding.window, cell.finding.channel);
    };
    variances_.push_back(cell.noise.variance[0] + cell.noise.variance[1]);
    growths_.push_back(std::max(growth(1), growth(-1)));
  }
  CellNoiseOfMean median() { return {median_of(variances_), median_of(growths_)}; }

 private:
  std::vector<double> variances_;
  std::vector<double> growths_;
};

}  // namespace

CellNoiseOfMean offer_coarse_cells(const CoarseImages& coarse, const Groups& groups,
                                   std::size_t channel, const NoisePyramid& noise,
                                   std::vector<BestCell>& best) {
  const Groups in_blocks = coarse_groups(groups);
  const WelchCells moments = window_moments(coarse, in_blocks, channel);
  TypicalNoise typical;
  for_each_window(in_blocks, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
    // Its constants are tested by themselves.
    if (!moments.varied(window)) return;
    const bool alternating = group.grid == Grid::alternating;
    const auto g = static_cast<std::size_t>(&group - in_blocks.data());
    Candidate candidate{.finding = {}, .noise = moments.noise(window)};
    candidate.finding.size = group.size;
    candidate.finding.window = groups[g].windows[i];
    candidate.finding.channel = channel;
    candidate.noise.alternates = alternating;
    if (alternating) candidate.finding.alternation = static_cast<Alternation>(i);
    const StudentValue value = own_value(candidate.noise);
    candidate.finding.z = t_to_z(value);
    ++best[g].windows;
    offer(best[g], candidate, noise);
    // A thousand cells tell a median. An odd step meets every column.
    const std::size_t step = group.windows.size() / 1024 | 1U;
    if (group.size == typical_side && group.grid == Grid::aligned && i % step == 0) {
      typical.add(candidate, noise);
    }
  });
  return typical.median();
}

}  // namespace assay::stats
