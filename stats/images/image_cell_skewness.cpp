#include "stats/images/image_cell_skewness.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "stats/basics/check.h"
#include "stats/basics/vector_copies.h"
#include "stats/gates/level_factors.h"
#include "stats/images/image_cell_moments.h"
#include "stats/images/image_family.h"
#include "stats/images/image_halves.h"
#include "stats/images/image_moments.h"
#include "stats/images/image_windows.h"
#include "stats/images/lost_lights.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "cell_tails";

using Groups = std::vector<WindowGroup>;

constexpr std::size_t most_choices = 8;

struct SidePart {
  const std::vector<CellMoments>& cells;
  double count;  // Images that the moments are of.
  double factor;
  double replicates;
};

ASSAY_VECTOR_COPIES void add_part(std::vector<Cumulants>& cells, const SidePart& side) {
  const CellMoments* const moments = side.cells.data();
  Cumulants* const __restrict sum = cells.data();
  const std::size_t size = cells.size();
  const double count = side.count;
  for (std::size_t i = 0; i < size; ++i) {
    const Cumulants part = cumulants_of_mean({.m2 = moments[i].m2,
                                              .m3 = moments[i].m3,
                                              .count = count,
                                              .factor = side.factor,
                                              .replicates = side.replicates});
    const bool varied = moments[i].m2 > 0;
    sum[i].variance += varied ? part.variance : 0.0;
    sum[i].third += varied ? part.third : 0.0;
    sum[i].third_variance += varied ? part.third_variance : 0.0;
  }
}

// Weights come from every `step`-th image of a side's pilot, and the rest of it takes them.
std::size_t step_of(const CellPilot& side, WeightsFrom from) {
  if (from == WeightsFrom::pilot) return halves;
  const double half = std::max(side.replicates / halves, 1.0);
  const double steps = static_cast<double>(replicates_of(side.stack)) / half;
  return static_cast<std::size_t>(std::max(steps, static_cast<double>(halves)));
}

// Adds the part of every `step`-th image from `start` on to the variance of the difference, for the
// elements from `first` on.
void add_variance(const CellPilot& side, EveryImage which, std::size_t first,
                  std::span<double> variance) {
  std::vector<double> mean(variance.size());
  std::vector<double> m2(variance.size());
  std::visit(
      [&](const auto& stack) {
        moments_of_range(stack, first, {mean, m2}, which);
      },
      side.stack);
  const std::size_t count = (replicates_of(side.stack) + which.step - 1 - which.start) / which.step;
  const double scale = side.factor * side.factor / side.replicates / static_cast<double>(count - 1);
  for (std::size_t i = 0; i < m2.size(); ++i) variance[i] += scale * m2[i];
}

// Weights of these rows and their neighbours. They are right in these rows alone.
std::vector<double> weights_of(std::span<const CellPilot> sides,
                               const std::vector<EveryImage>& which, RowRange rows,
                               const ForEach& for_each) {
  constexpr std::size_t at_a_time = std::size_t{1} << 15;
  const ImageExtent& extent = extent_of(sides[0].stack);
  const RowRange wider = with_neighbours(rows, extent);
  const ElementRange range = wider.elements(extent);
  std::vector<double> variance(range.size());
  for_each((range.size() + at_a_time - 1) / at_a_time, [&](std::size_t i) {
    const std::size_t done = i * at_a_time;
    const auto some =
        std::span(variance).subspan(done, std::min(at_a_time, variance.size() - done));
    for (std::size_t s = 0; s < sides.size(); ++s) {
      add_variance(sides[s], which[s], range.first + done, some);
    }
  });
  std::vector<double> weight =
      steadied({extent.width, wider.last - wider.first, extent.channels}, variance);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = variance[i] > 0 ? 1 / std::sqrt(weight[i]) : 0;
  }
  return weight;
}

Groups aligned_groups(const ImageExtent& extent) {
  Groups groups = window_groups(extent, 1 - energy_share, RowCellMoments::row_unit + 1);
  std::erase_if(groups, [](const WindowGroup& group) { return group.grid != Grid::aligned; });
  return groups;
}

// Empty factors of each group, at the critical value that one cell must reach.
std::vector<LevelFactors> no_factors(const Groups& groups, const ImageExtent& extent,
                                     double level) {
  std::vector<LevelFactors> factors;
  for (const WindowGroup& group : groups) {
    const double cells = static_cast<double>(aligned_cells(extent, group.size) * extent.channels);
    const double tail = level * group.share / cells / 2;
    factors.emplace_back(normal_quantile({Tail::upper, std::log(tail)}));
  }
  return factors;
}

void check_sides(const char* function, std::span<const CellPilot> sides) {
  for (const CellPilot& side : sides) {
    std::visit([&](const auto& stack) { check::image_stack(function, stack); }, side.stack);
    check::same_extent(function, extent_of(side.stack), extent_of(sides[0].stack));
  }
}

}  // namespace

RowCellTails::RowCellTails(std::span<const CellPilot> sides, double level, WeightsFrom from,
                           ForEach for_each)
    : extent_(extent_of(sides[0].stack)),
      for_each_(std::move(for_each)),
      groups_(aligned_groups(extent_)) {
  check::inside_unit({function_name, "level"}, level);
  check_sides(function_name, sides);
  std::size_t choices = most_choices;
  for (const CellPilot& side : sides) {
    sides_.push_back({side.factor, side.replicates, step_of(side, from)});
    choices = std::min(choices, sides_.back().step);
  }
  const std::vector<LevelFactors> factors = no_factors(groups_, extent_, level);
  const RowCellMoments cells(extent_, groups_);
  const std::vector<double> none(cells.tiles().elements());
  for (std::size_t i = 0; i < choices; ++i) {
    choices_.push_back({i, std::vector<RowCellMoments>(sides.size(), cells),
                        std::vector<std::vector<double>>(extent_.channels, none),
                        std::vector<std::vector<LevelFactors>>(extent_.channels, factors)});
  }
}

void RowCellTails::take(std::span<const CellPilot> sides, RowRange rows) {
  for (Choice& choice : choices_) take(sides, rows, choice);
}

std::vector<EveryImage> RowCellTails::images_of(const Choice& choice) const {
  std::vector<EveryImage> which;
  for (const Side& side : sides_) which.push_back({choice.images, side.step});
  return which;
}

void RowCellTails::add_side(const Side& side, double count, const ChannelMoments& moments,
                            ChannelCumulants& cells) const {
  cells.resize(extent_.channels);
  for_each_(extent_.channels, [&](std::size_t c) {
    cells[c].resize(moments[c].size());
    add_part(cells[c], {moments[c], count, side.factor, side.replicates});
  });
}

void RowCellTails::take(std::span<const CellPilot> sides, RowRange rows, Choice& choice) {
  const std::vector<EveryImage> weighing = images_of(choice);
  const std::vector<double> weights = weights_of(sides, weighing, rows, for_each_);
  const std::size_t first_weight = with_neighbours(rows, extent_).elements(extent_).first;
  count_weighted(std::span(weights).subspan(rows.elements(extent_).first - first_weight), rows,
                 choice);
  std::vector<LostLight> lost;
  ChannelCumulants cells;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto some = lost_lights(sides[s], weighing[s], weights, first_weight, rows);
    lost.insert(lost.end(), some.begin(), some.end());
    const auto of_stack = [&](const auto& stack) {
      return choice.cells[s].take(
          WeightedImages{stack, weights, first_weight, sides_[s].step, choice.images}, rows,
          for_each_);
    };
    const ChannelMoments moments = std::visit(of_stack, sides[s].stack);
    add_side(sides_[s], static_cast<double>(choice.cells[s].images()), moments, cells);
  }
  add_lost(lost, rows, choice, cells);
  add_cells(cells, rows, choice);
  choice.lost.insert(choice.lost.end(), lost.begin(), lost.end());
}

void RowCellTails::add_lost(std::span<const LostLight> lost, RowRange rows, const Choice& choice,
                            ChannelCumulants& cells) const {
  std::size_t done = 0;
  for (const WindowGroup& group : groups_) {
    if (choice.cells[0].is_larger(group)) continue;
    const std::size_t in_a_row = (extent_.width + group.size - 1) / group.size;
    for (const LostLight& light : lost) {
      const std::size_t cell =
          (light.y - rows.first) / group.size * in_a_row + light.x / group.size;
      add_to(cells[light.channel][done + cell], light.cumulants);
    }
    done += choice.cells[0].cells_in(group, rows);
  }
}

void RowCellTails::add_lost_to_larger(const Choice& choice, ChannelCumulants& cells) const {
  std::size_t done = 0;
  for (const WindowGroup& group : groups_) {
    if (!choice.cells[0].is_larger(group)) continue;
    for (std::size_t i = 0; i < group.windows.size(); ++i) {
      const Rectangle& window = group.windows[i];
      for (const LostLight& light : choice.lost) {
        const bool inside = light.x - window.x < window.width && light.y - window.y < window.height;
        if (inside) add_to(cells[light.channel][done + i], light.cumulants);
      }
    }
    done += group.windows.size();
  }
}

void RowCellTails::add_cells(const ChannelCumulants& cells, RowRange rows, Choice& choice) const {
  for_each_(extent_.channels, [&](std::size_t c) {
    std::size_t done = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (choice.cells[0].is_larger(groups_[g])) continue;
      const std::size_t count = choice.cells[0].cells_in(groups_[g], rows);
      choice.factors[c][g].add(std::span(cells[c]).subspan(done, count));
      done += count;
    }
  });
}

// Counts weights, which begin with the first of these rows.
void RowCellTails::count_weighted(std::span<const double> weights, RowRange rows,
                                  Choice& choice) const {
  const RowCellMoments& cells = choice.cells[0];
  std::size_t i = 0;
  for (std::size_t y = rows.first; y < rows.last; ++y) {
    const std::size_t row = y / cells.tile_side() * cells.tiles().width;
    for (std::size_t x = 0; x < extent_.width; ++x) {
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        choice.weighted[c][row + x / cells.tile_side()] += weights[i++] > 0 ? 1 : 0;
      }
    }
  }
}

void RowCellTails::add_larger(Choice& choice) const {
  ChannelCumulants cells;
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    add_side(sides_[s], static_cast<double>(choice.cells[s].images()),
             choice.cells[s].larger(for_each_), cells);
  }
  for (std::size_t c = 0; c < extent_.channels; ++c) {
    const std::vector<double> weighted = choice.cells[0].larger_sums(choice.weighted[c]);
    for (std::size_t i = 0; i < weighted.size(); ++i) {
      // Nothing varied in it. The value is only the rounding of the larger sums it was taken from.
      if (weighted[i] == 0) cells[c][i] = {};
    }
  }
  add_lost_to_larger(choice, cells);
  for (std::size_t c = 0; c < extent_.channels; ++c) {
    std::size_t done = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!choice.cells[0].is_larger(groups_[g])) continue;
      const std::size_t count = groups_[g].windows.size();
      choice.factors[c][g].add(std::span(cells[c]).subspan(done, count));
      done += count;
    }
  }
}

LevelFactors RowCellTails::factors_of(std::size_t group) const {
  LevelFactors sum = choices_[0].factors[0][group];
  for (std::size_t i = 1; i < choices_.size() * extent_.channels; ++i) {
    sum.merge(choices_[i / extent_.channels].factors[i % extent_.channels][group]);
  }
  return sum;
}

std::vector<CellTails> RowCellTails::tails() {
  for (Choice& choice : choices_) add_larger(choice);
  std::vector<CellTails> tails;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const LevelFactors factors = factors_of(g);
    CellTails& tail = tails.emplace_back();
    tail.size = groups_[g].size;
    if (factors.count() == 0) continue;
    tail.factor = factors.factor();
    tail.common_skewness =
        factors.common_skewness(static_cast<double>(choices_.size() * extent_.channels));
    tail.common = factors.factor_of(tail.common_skewness);
    // Channels may depend on each other, so only cells count.
    tail.scatter =
        factors.excess() / std::sqrt(static_cast<double>(aligned_cells(extent_, groups_[g].size)));
  }
  return tails;
}

std::vector<double> cell_weights(std::span<const CellPilot> sides) {
  check_sides("cell_weights", sides);
  const RowRange all{0, extent_of(sides[0].stack).height};
  return weights_of(sides, std::vector<EveryImage>(sides.size()), all, one_by_one);
}

std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level, WeightsFrom from,
                                  const ForEach& for_each) {
  // The cells' data is not kept for all rows at a time.
  constexpr std::size_t rows_at_a_time = 256;
  RowCellTails tails(sides, level, from, for_each);
  const std::size_t height = extent_of(sides[0].stack).height;
  for (std::size_t row = 0; row < height; row += rows_at_a_time) {
    tails.take(sides, {row, std::min(row + rows_at_a_time, height)});
  }
  return tails.tails();
}

}  // namespace assay::stats
