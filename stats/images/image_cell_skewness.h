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

// How far skewness moves the tails of the sums over cells that image_pyramid.h looks at, as a pilot
// shows it.
//
// One side of the comparison: pilot replicates, and the mean over later ones that is to be tested.
struct CellPilot {
  AnyImageStack stack;
  double factor = 1;      // the difference is the sum over the sides of factor * mean
  double replicates = 1;  // of the pilot's kind in that mean
};

struct CellTails {
  std::uint32_t size = 1;  // side of the cells; the longer side of the image at last
  double factor = 1;
  double common_skewness = 0;  // at least, of the numerators, in common to the cells
  double common = 1;           // at least, of the skewness that the cells have in common
  double scatter = 0;  // by so much the factor of a normal pilot exceeds 1 with probability 1e-4
};

// For each size of aligned cell, fine to coarse: the mean over its cells of cosh(g x^3 / 3), the
// factor by which both tails of a studentised sum at x together depart from nominal, g the skewness
// of its numerator (assumption_gates.h). The mean, since false alarms add up; x is where one cell
// must be to be found at `level`, by the share of its size (image_windows.h). Cells that never
// varied do not count.
//
// A cell's sum is weighted as in the test, and never by weights from the images that it sums: what
// an image of the pilot lit (a firefly) has no weight among its own, and all of it among those that
// follow. Weights of a pilot are stood for by those that either half of it gives to the other.
// Where halves of the test weigh each other, as many images of the pilot as half a test has give
// the rest their weights, up to eight such choices averaged.
//
// The pilot's own scatter is divided out: a sample skewness has variance 6 / n at the normal law,
// and E cosh(c (g + error)) = cosh(c g) exp(c^2 var / 2). What is left of it is `scatter`, for one
// cell cosh(3.9 c sd) exp(-c^2 var / 2) - 1, a 1 / sqrt(cells) of it for their mean.
//
// Of few replicates that says little: skewness 2 in 16 of them is lost in the scatter of one cell.
// What all cells have in common is not: `common` is cosh(c g) at the skewness of level_factors.h,
// with its sign, less 3.9 of its standard errors (those of independent cells; of others it may be
// too large).
// Throws std::domain_error as image_stack does, for different extents, and for a level outside
// (0, 1).
enum class WeightsFrom { halves_of_the_test, pilot };
std::vector<CellTails> cell_tails(std::span<const CellPilot> sides, double level,
                                  WeightsFrom from = WeightsFrom::halves_of_the_test,
                                  const ForEach& for_each = one_by_one);

// The same of pilots of which some rows are there at a time, with the same bits.
class RowCellTails {
 public:
  // `sides` tell the extent, the number of images and what the rest of them says.
  RowCellTails(std::span<const CellPilot> sides, double level,
               WeightsFrom from = WeightsFrom::halves_of_the_test, ForEach for_each = one_by_one);

  // Rows that follow on those before: multiples of row_unit, but for the last. The stacks must have
  // `rows_beside` more at either side, as far as the image has.
  static constexpr std::size_t row_unit = RowCellMoments::row_unit;
  static constexpr std::size_t rows_beside = 1;
  void take(std::span<const CellPilot> sides, RowRange rows);

  // After the last rows.
  std::vector<CellTails> tails();

 private:
  // Of one choice of weights.
  struct Choice {
    std::size_t images;                 // the first of those that they come from
    std::vector<RowCellMoments> cells;  // of each side
    // How many of a tile's elements have a weight, of each channel: counted in integers, where sums
    // leave no rounding.
    std::vector<std::vector<double>> weighted;
    std::vector<std::vector<LevelFactors>> factors;  // of a channel's groups
    std::vector<LostLight> lost;
  };

  // What one side of the comparison is beside its stack.
  struct Side {
    double factor;
    double replicates;
    std::size_t step;  // of this many images one gives weights to the others
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
// its 3 x 3 neighbours; 0 where it did not vary itself. Throws std::domain_error as cell_tails
// does.
std::vector<double> cell_weights(std::span<const CellPilot> sides);

}  // namespace assay::stats
