#include "stats/image_cell_skewness.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "stats/check.h"
#include "stats/image_cell_moments.h"
#include "stats/image_family.h"
#include "stats/image_halves.h"
#include "stats/image_moments.h"
#include "stats/image_windows.h"
#include "stats/level_factors.h"
#include "stats/tails.h"
#include "stats/vector_copies.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "cell_tails";

using Groups = std::vector<WindowGroup>;

// Choices of weights that are looked at, where the pilot has so many.
constexpr std::size_t most_choices = 8;

// One side's part in them.
struct SidePart {
  const std::vector<CellMoments>& cells;
  double count;  // images that the moments are of
  double factor;
  double replicates;
};

ASSAY_VECTOR_COPIES void add_side(std::vector<Cumulants>& cells, const SidePart& side) {
  const CellMoments* const moments = side.cells.data();
  Cumulants* const __restrict sum = cells.data();
  const std::size_t size = cells.size();
  const double count = side.count;
  for (std::size_t i = 0; i < size; ++i) {
    const double m2 = moments[i].m2;
    const double deviation = side.factor * std::sqrt(m2 / (count - 1));
    const double skewness = std::sqrt(count / m2) * (moments[i].m3 / m2);
    const double scale = deviation * deviation * deviation / (side.replicates * side.replicates);
    const bool varied = m2 > 0;
    sum[i].variance += varied ? deviation * deviation / side.replicates : 0.0;
    sum[i].third += varied ? scale * skewness : 0.0;
    sum[i].third_variance += varied ? 6 / count * scale * scale : 0.0;
  }
}

// Weights come from every `step`-th image of a side's pilot, from `first` on, the rest of it is
// what they are given to: as a test's halves do.
std::size_t step_of(const CellPilot& side) {
  const double half = std::max(side.replicates / halves, 1.0);
  const double steps = static_cast<double>(replicates_of(side.stack)) / half;
  return static_cast<std::size_t>(std::max(steps, static_cast<double>(halves)));
}

// Of every `step`-th image from `first` on.
std::vector<double> weights_of(std::span<const CellPilot> sides,
                               const std::vector<EveryImage>& which) {
  const ImageExtent& extent = extent_of(sides[0].stack);
  std::vector<double> variance(extent.elements());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const CellPilot& side = sides[s];
    std::vector<double> mean(extent.elements());
    std::vector<double> m2(extent.elements());
    std::visit(
        [&](const auto& stack) {
          moments_of_range(stack, 0, {mean, m2}, which[s]);
        },
        side.stack);
    const std::size_t step = which[s].step;
    const std::size_t count = (replicates_of(side.stack) + step - 1 - which[s].start) / step;
    const double scale =
        side.factor * side.factor / side.replicates / static_cast<double>(count - 1);
    for (std::size_t i = 0; i < m2.size(); ++i) variance[i] += scale * m2[i];
  }
  std::vector<double> weight = steadied(extent, variance);
  for (double& value : weight) value = value > 0 ? 1 / std::sqrt(value) : 0;
  return weight;
}

std::vector<double> weights_of_choice(std::span<const CellPilot> sides, std::size_t first) {
  std::vector<EveryImage> which;
  for (const CellPilot& side : sides) which.push_back({first, step_of(side)});
  return weights_of(sides, which);
}

struct Weights {
  std::span<const double> value;
  std::optional<std::size_t> choice;  // of the images they come from; none: from elsewhere
};

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

Groups aligned_groups(const ImageExtent& extent) {
  Groups groups = window_groups(extent, 1 - energy_share);
  std::erase_if(groups, [](const WindowGroup& group) { return group.grid != Grid::aligned; });
  return groups;
}

// Of every size of cell.
class FactorMeans {
 public:
  FactorMeans(const ImageExtent& extent, double level, const ForEach& for_each)
      : extent_(extent), groups_(aligned_groups(extent)), for_each_(for_each) {
    for (const WindowGroup& group : groups_) {
      const double cells = static_cast<double>(group.windows.size() * extent.channels);
      const double tail = level * group.share / cells / 2;
      factors_.emplace_back(normal_quantile({Tail::upper, std::log(tail)}));
    }
  }

  void add(std::span<const CellPilot> sides, const Weights& weights) {
    std::vector<std::vector<Cumulants>> cells(extent_.channels);
    for (const CellPilot& side : sides) {
      const auto of_stack = [&](const auto& stack) {
        const WeightedImages images{stack, weights.value, step_of(side), weights.choice};
        const double count = static_cast<double>(images.taken().size());
        const auto moments = cell_moments(images, groups_, for_each_);
        for_each_(extent_.channels, [&](std::size_t c) {
          cells[c].resize(moments[c].size());
          add_side(cells[c], {moments[c], count, side.factor, side.replicates});
        });
      };
      std::visit(of_stack, side.stack);
    }
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      add_cells(cells[c], varied_windows(extent_, groups_, weights.value, c));
    }
  }

  std::vector<CellTails> tails() const {
    std::vector<CellTails> tails;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      CellTails& tail = tails.emplace_back();
      tail.size = groups_[g].size;
      if (factors_[g].count() == 0) continue;
      tail.factor = factors_[g].factor();
      // Channels may depend on each other, cells count.
      const double cells = static_cast<double>(groups_[g].windows.size());
      tail.scatter = factors_[g].excess() / std::sqrt(cells);
    }
    return tails;
  }

 private:
  void add_cells(const std::vector<Cumulants>& cells, const std::vector<bool>& varied) {
    std::size_t first = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::size_t count = groups_[g].windows.size();
      factors_[g].add(std::span(cells).subspan(first, count), varied, first);
      first += count;
    }
  }

  ImageExtent extent_;
  Groups groups_;
  const ForEach& for_each_;
  std::vector<LevelFactors> factors_;  // of each group
};

void check_sides(const char* function, std::span<const CellPilot> sides) {
  for (const CellPilot& side : sides) {
    std::visit([&](const auto& stack) { check::image_stack(function, stack); }, side.stack);
    check::same_extent(function, extent_of(side.stack), extent_of(sides[0].stack));
  }
}

}  // namespace

std::vector<double> cell_weights(std::span<const CellPilot> sides) {
  check_sides("cell_weights", sides);
  return weights_of(sides, std::vector<EveryImage>(sides.size()));
}

std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level,
                                  std::span<const double> weights, const ForEach& for_each) {
  check::inside_unit({function_name, "level"}, level);
  check_sides(function_name, sides);
  const ImageExtent& extent = extent_of(sides[0].stack);
  if (!weights.empty() && weights.size() != extent.elements()) {
    check::fail({function_name, "weights.size()"}, weights.size(), "that of the elements");
  }
  FactorMeans means(extent, level, for_each);
  if (!weights.empty()) {
    means.add(sides, {weights, {}});
  } else {
    std::size_t choices = most_choices;
    for (const CellPilot& side : sides) choices = std::min(choices, step_of(side));
    for (std::size_t choice = 0; choice < choices; ++choice) {
      means.add(sides, {weights_of_choice(sides, choice), choice});
    }
  }
  return means.tails();
}

}  // namespace assay::stats
