#include "stats/image_cell_skewness.h"

#include <algorithm>
#include <cmath>

#include "stats/check.h"
#include "stats/image_family.h"
#include "stats/image_moments.h"
#include "stats/image_windows.h"
#include "stats/moments.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "cell_tails";

using Groups = std::vector<WindowGroup>;

// Of the numerator of a studentised sum.
struct Cumulants {
  double variance = 0;
  double third = 0;
  double third_variance = 0;  // of the estimate of `third`, were the law normal
};

void add_side(std::vector<Cumulants>& cells, const std::vector<Moments>& pilot,
              const CellPilot& side) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!(pilot[i].m2 > 0)) continue;
    const double deviation = side.factor * pilot[i].standard_deviation();
    const double scale = deviation * deviation * deviation / (side.replicates * side.replicates);
    cells[i].variance += deviation * deviation / side.replicates;
    cells[i].third += scale * pilot[i].skewness();
    cells[i].third_variance += 6 / static_cast<double>(pilot[i].count) * scale * scale;
  }
}

// Of every element, 0 where nothing varied.
std::vector<double> weights_of(std::span<const CellPilot> sides) {
  const ImageExtent& extent = sides[0].stack.extent;
  std::vector<double> variance(extent.elements());
  for (const CellPilot& side : sides) {
    std::vector<double> mean(extent.elements());
    std::vector<double> m2(extent.elements());
    moments_of_range(side.stack, 0, {mean, m2}, {});
    const double scale = side.factor * side.factor / side.replicates /
                         static_cast<double>(side.stack.images.size() - 1);
    for (std::size_t i = 0; i < m2.size(); ++i) variance[i] += scale * m2[i];
  }
  for (double& value : variance) value = value > 0 ? 1 / std::sqrt(value) : 0;
  return variance;
}

// Windows of all groups in a row, of one channel and one side.
std::vector<Moments> window_moments(const CellPilot& side, const Groups& groups,
                                    std::span<const double> weight, std::size_t channel) {
  const ImageExtent& extent = side.stack.extent;
  std::size_t windows = 0;
  for (const WindowGroup& group : groups) windows += group.windows.size();
  std::vector<Moments> moments(windows);
  WindowSums sums(extent);
  std::vector<double> values(extent.width * extent.height);
  for (const std::span<const double> image : side.stack.images) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t e = i * extent.channels + channel;
      values[i] = weight[e] * (image[e] - side.stack.images[0][e]);
    }
    sums.load(values);
    std::size_t window = 0;
    for (const WindowGroup& group : groups) {
      for (std::size_t i = 0; i < group.windows.size(); ++i) {
        moments[window++].add(sums.of(group, i));
      }
    }
  }
  return moments;
}

// Whether anything varied in them; counted in integers, where sums leave no rounding.
std::vector<bool> varied_windows(const ImageExtent& extent, const Groups& groups,
                                 std::span<const double> weight, std::size_t channel) {
  std::vector<double> values(extent.width * extent.height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = weight[i * extent.channels + channel] > 0 ? 1 : 0;
  }
  WindowSums sums(extent);
  sums.load(values);
  std::vector<bool> varied;
  for (const WindowGroup& group : groups) {
    for (std::size_t i = 0; i < group.windows.size(); ++i) varied.push_back(sums.of(group, i) > 0);
  }
  return varied;
}

// The mean of one size's factors.
class FactorMean {
 public:
  explicit FactorMean(double x) : scale_(x * x * x / 3) {}

  void add(const Cumulants& cell) {
    const double unit = scale_ / std::pow(cell.variance, 1.5);
    const double scatter = unit * unit * cell.third_variance;
    ++count_;
    sum_ += std::cosh(unit * cell.third) * std::exp(-scatter / 2);
  }

  double value() const { return count_ > 0 ? std::max(1.0, sum_ / count_) : 1; }

 private:
  double scale_;
  double sum_ = 0;
  double count_ = 0;
};

Groups aligned_groups(const ImageExtent& extent) {
  Groups groups = window_groups(extent, 1 - energy_share);
  std::erase_if(groups, [](const WindowGroup& group) { return group.grid != Grid::aligned; });
  return groups;
}

std::vector<FactorMean> empty_means(const Groups& groups, std::size_t channels, double level) {
  std::vector<FactorMean> means;
  for (const WindowGroup& group : groups) {
    const double cells = static_cast<double>(group.windows.size() * channels);
    const double tail = level * group.share / cells / 2;
    means.emplace_back(normal_quantile({Tail::upper, std::log(tail)}));
  }
  return means;
}

}  // namespace

std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level) {
  check::inside_unit({function_name, "level"}, level);
  for (const CellPilot& side : sides) {
    check::image_stack(function_name, side.stack);
    check::same_extent(function_name, side.stack.extent, sides[0].stack.extent);
  }
  const ImageExtent& extent = sides[0].stack.extent;
  const Groups groups = aligned_groups(extent);
  const std::vector<double> weight = weights_of(sides);
  std::vector<FactorMean> means = empty_means(groups, extent.channels, level);
  for (std::size_t c = 0; c < extent.channels; ++c) {
    const std::vector<bool> varied = varied_windows(extent, groups, weight, c);
    std::vector<Cumulants> cells(varied.size());
    for (const CellPilot& side : sides)
      add_side(cells, window_moments(side, groups, weight, c), side);
    std::size_t window = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (std::size_t i = 0; i < groups[g].windows.size(); ++i, ++window) {
        if (varied[window]) means[g].add(cells[window]);
      }
    }
  }
  std::vector<CellTails> tails;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    tails.push_back({groups[g].size, means[g].value()});
  }
  return tails;
}

}  // namespace assay::stats
