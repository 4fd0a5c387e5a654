#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image_family.h"
#include "stats/images/image_halves.h"
#include "stats/pyramids/image_noise.h"
#include "stats/tails/tails.h"

namespace assay::stats {

// Internal to image_pyramid: its cells.

// ---- Statistics of cells

// Half of the difference of a half counts in the mean of both halves.
inline constexpr double factor_of_half = 1.0 / halves;

// Welch's statistic of many cells, whose effect is the mean of both halves' weighted means of
// a - b. Replicates come in parts, the halves of either side, each with variances of its own.
struct WelchCells {
  // The current half: 1 / the sum of each cell's weights.
  std::vector<double> inverse;
  // The current part: sums over replicates of squared deviations of each cell's sum from its mean.
  std::vector<double> squares;
  // The halves so far, which the caller adds up.
  std::vector<double> effect;
  std::vector<double> weights;  // CellNoise has the meaning of these three.
  std::vector<double> concentration;
  std::vector<double> third;
  // The parts that are done.
  std::array<std::vector<double>, sides_of_pair> variance;  // Squared error of effect, by side.
  std::array<std::vector<double>, halves> of_half;          // The same, by half.
  std::vector<double> reciprocal_degrees;  // Sum of variance_g^2 / (n_g - 1) over the parts.

  void start(std::size_t cells);
  // A half begins: sums of the weights of cells from this one on.
  void start_half(std::size_t first, std::span<const double> sums);
  // Adds the half's sums of cells from this one on, divided by the sum of the weights to `power`.
  void add(std::vector<double>& to, std::size_t first, std::span<const double> sums,
           int power) const;
  // The replicates since the last call are a part of that half and side.
  void finish_part(std::size_t half, std::size_t side, double count);

  // Sums that did not vary in both halves are too little known to be tested.
  bool varied(std::size_t cell) const { return of_half[0][cell] > 0 && of_half[1][cell] > 0; }
  // The statistic of cells from this one on, not a number of those that did not vary.
  void statistics(std::size_t first, std::span<double> t) const;
  CellNoise noise(std::size_t cell) const;
};

// A cell whose neighbours are not known yet. finding.z is its own.
struct Candidate {
  ImageFinding finding;
  CellNoise noise;
};

// The cells of one group in a tile that are farthest from zero by their own noise, and the one of
// the largest t. It counts the cells that they were chosen from.
class Candidates {
 public:
  // Counts a cell with this t. True if it may be one of those that are kept.
  bool wants(double t);
  // finding.z must be set.
  void keep(const Candidate& candidate);
  const std::vector<Candidate>& kept() const { return kept_; }
  const std::optional<Candidate>& clearest() const { return clearest_; }
  double windows() const { return windows_; }

 private:
  static constexpr std::size_t most = 4;
  std::vector<Candidate> kept_;
  std::optional<Candidate> clearest_;
  double largest_t_ = 0;
  double windows_ = 0;
};

// The cell of a group that is farthest from zero once its neighbours are heard, so far. Among
// equals the first by channel, row and column wins, in whichever order they come. `clearest` is the
// one of the largest t.
struct BestCell {
  std::optional<ImageFinding> finding;
  std::optional<ImageFinding> clearest;
  double windows = 0;
};
void offer(BestCell& best, const Candidate& candidate, const NoisePyramid& noise);

// The value that a cell's own noise gives.
StudentValue own_value(const CellNoise& noise);

// ---- Fine cells

// Nearly all cells are small, and an image has many replicates. So elements and cells of sides 2, 4
// and 8 are tested tile by tile over all replicates, which keeps a tile in the cache. Larger cells
// are summed from blocks of 4 x 4, which this pass leaves behind.

inline constexpr std::size_t alternations = 3;  // By column, by row, checkerboard.
inline constexpr std::uint32_t block_side = 4;
// Blocks that cover so many elements of a row or column.
inline std::size_t blocks_of(std::size_t count) { return (count + block_side - 1) / block_side; }

// The smallest size that is not fine, but for a whole image.
inline constexpr std::uint32_t coarse_size = 16;
// True if the cells of a group are tested here.
bool is_fine(const WindowGroup& group);

// Sums of an image's numbers over blocks of 4 x 4 elements, the last cut off at the edge. Beside
// them its sums with alternating signs, `alternations` a channel.
template <class Number>
struct BlockSums {
  std::vector<Number> blocks;
  std::vector<double> alternating;
};

struct CoarseHalf {
  // [side][replicate of the half]: weighted deviations from the mean of the half. They only serve
  // variances, so single precision does.
  std::array<std::vector<BlockSums<float>>, sides_of_pair> images;
  BlockSums<double> effect;  // Weighted differences of the means.
  BlockSums<double> varied;  // Number of elements that vary and have a weight.
  BlockSums<double> weights;
  BlockSums<double> squared_weights;
  BlockSums<double> squared_error;  // The reference's, weighted; empty without one.
  BlockSums<double> third;          // Third cumulants of the effects; none with alternating signs.
};

struct CoarseImages {
  ImageExtent extent;  // In blocks.
  std::array<CoarseHalf, halves> half;
};

struct ElementCounts {
  std::size_t tested = 0;
  std::size_t equal_constants = 0;
};

// Input of the test of fine cells: replicates, halves with the weights that each gives the other,
// and groups of cells. With `constants_decide` constants that differ are unseen elements.
struct FineCells {
  const ImagePair& pair;
  const std::array<Half, halves>& half;
  const std::vector<WindowGroup>& groups;
  bool constants_decide;
};

struct FineFindings {
  CoarseImages coarse;
  NoisePyramid noise;
  std::vector<NoisePyramid::SquaresOfSides> squares;  // Of a tile, by channel.
  std::vector<std::vector<Candidates>> tiles;         // A group's candidates, in every tile.
  ElementCounts counts;
  std::vector<UnseenElement> unseen = {};
  std::vector<float> weights;  // Every element's, averaged over the halves.
  std::span<double> z;         // Every element's alone, by its own noise.
};

// Nothing found yet; z has room for every element.
FineFindings empty_findings(const ImagePair& pair, std::span<double> z);

// Rows are taken in multiples of fine_rows, but for the image's last. Cells that begin in them
// reach fine_rows_ahead rows further. The images and halves must have those rows.
inline constexpr std::size_t fine_rows = 32;
inline constexpr std::size_t fine_rows_ahead = 8;

// Collects the candidates among the fine cells that begin in these rows, and fills in their blocks
// and noise.
void offer_fine_cells(const FineCells& cells, RowRange rows, FineFindings& found,
                      const ForEach& for_each = one_by_one);

// To be called after the last rows.
void add_up_alternating(CoarseImages& coarse);

// ---- Coarse cells

// Offers one channel's coarse cells and alternating sums to the best of
// their groups, from the sums over blocks. Answers the noise of its typical cell.
CellNoiseOfMean offer_coarse_cells(const CoarseImages& coarse,
                                   const std::vector<WindowGroup>& groups, std::size_t channel,
                                   const NoisePyramid& noise, std::vector<BestCell>& best);

}  // namespace assay::stats
