#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/gates/level_factors.h"
#include "stats/images/image.h"
#include "stats/images/image_cell_moments.h"
#include "stats/images/image_moments.h"
#include "stats/images/lost_lights.h"

namespace assay::stats {

// How far skewness moves the tails of the sums over cells that image_pyramid.h looks at. A pilot
// shows it.
//
// CellPilot is one side of the comparison: pilot replicates, and the mean over later ones that is
// to be tested.
struct CellPilot {
  AnyImageStack stack;
  double factor = 1;      // The difference is the sum over the sides of factor * mean.
  double replicates = 1;  // Number of replicates like the pilot's in that mean.
};

struct CellTails {
  std::uint32_t size = 1;  // Side of the cells; for the last, the longer side of the image.
  double factor = 1;
  // Lower bound of the skewness that the cells' numerators have in common.
  double common_skewness = 0;
  double common = 1;   // Lower bound of the factor that this skewness alone makes.
  double scatter = 0;  // A normal pilot's factor exceeds 1 by more than this with probability 1e-4.
};

// For each size of aligned cell, fine to coarse: the mean over its cells of cosh(g x^3 / 3). By
// that factor both tails of a studentised sum at x together depart from nominal. g is the skewness
// of the sum's numerator (assumption_gates.h). The mean is used because false alarms add up. One
// cell must reach x to be found at `level`, by the share of its size (image_windows.h). Cells that
// never varied do not count.
//
// A cell's sum is weighted as in the test, and never by weights from the images that it sums.
// Weights that either half gives to the other stand for those of a pilot. If halves of the test
// weigh each other, weights come from as many pilot images as half a test has. Up to eight
// such choices are averaged.
//
// The pilot's own scatter is divided out. A sample skewness has variance 6 / n at the normal law,
// and E cosh(c (g + error)) = cosh(c g) exp(c^2 var / 2). The remainder is `scatter`. For one cell
// it is cosh(3.9 c sd) exp(-c^2 var / 2) - 1. For the mean of the cells it is 1 / sqrt(cells) of
// that.
//
// With few replicates one cell's skewness is lost in the scatter, but skewness common to all cells
// is not. The member `common` is cosh(c g) at the skewness of level_factors.h, with its sign, less
// 3.9 standard errors. Those errors assume independent cells; for others `common` may be too large.
// Throws std::domain_error as image_stack does, for different extents, and for a level outside (0,
// 1).
enum class WeightsFrom { halves_of_the_test, pilot };
std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level,
                                  WeightsFrom from = WeightsFrom::halves_of_the_test,
                                  const ForEach& for_each = one_by_one);

// The same for pilots that are read rows after rows, with the same bits.
class RowCellTails {
 public:
  // Only the extent, the number of images and the scalars of `sides` are read.
  RowCellTails(std::span<const CellPilot> sides, double level,
               WeightsFrom from = WeightsFrom::halves_of_the_test, ForEach for_each = one_by_one);

  // Takes rows that follow on those before, in multiples of row_unit but for the last. The stacks
  // must have `rows_beside` more at either side, as far as the image has.
  static constexpr std::size_t row_unit = RowCellMoments::row_unit;
  static constexpr std::size_t rows_beside = 1;
  void take(std::span<const CellPilot> sides, RowRange rows);

  // After the last rows.
  std::vector<CellTails> tails();

 private:
  // One choice of weights.
  struct Choice {
    std::size_t images;                 // The first image that they come from.
    std::vector<RowCellMoments> cells;  // One per side.
    // Number of a tile's elements with a weight, for each channel.
    std::vector<std::vector<double>> weighted;
    std::vector<std::vector<LevelFactors>> factors;  // One per channel and group.
    std::vector<LostLight> lost;
  };

  // One side of the comparison without its stack.
  struct Side {
    double factor;
    double replicates;
    std::size_t step;  // One of this many images gives weights to the others.
  };
  using ChannelCumulants = std::vector<std::vector<Cumulants>>;

  void take(std::span<const CellPilot> sides, RowRange rows, Choice& choice);
  void count_weighted(std::span<const double> weights, RowRange rows, Choice& choice) const;
  void add_side(const Side& side, double count, const ChannelMoments& moments,
                ChannelCumulants& cells) const;
  void add_cells(const ChannelCumulants& cells, RowRange rows, Choice& choice) const;
  void add_lost(std::span<const LostLight> lost, RowRange rows, const Choice& choice,
                ChannelCumulants& cells) const;
  void add_larger(Choice& choice) const;
  void add_lost_to_larger(const Choice& choice, ChannelCumulants& cells) const;
  LevelFactors factors_of(std::size_t group) const;
  std::vector<EveryImage> images_of(const Choice& choice) const;

  ImageExtent extent_;
  ForEach for_each_;
  std::vector<WindowGroup> groups_;
  std::vector<Side> sides_;
  std::vector<Choice> choices_;
};

// Weights for image_pyramid.h: 1 / sqrt of the difference's variance at each element, steadied by
// its 3 x 3 neighbours. An element that did not vary has weight 0. Throws std::domain_error as
// cell_tails does.
std::vector<double> cell_weights(std::span<const CellPilot> sides);

}  // namespace assay::stats
