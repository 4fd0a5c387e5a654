#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "stats/images/image.h"
#include "stats/images/image_family.h"

namespace assay::stats {

// Internal to image_pyramid: what neighbours tell of the noise of a cell.
//
// A mean and its variance move together where noise is skewed. A cell that missed the rare bright
// values that carry part of its mean is too dark, and its variance says that it is exact. Let k2
// and k3 be the second and third cumulants of its noise. Were its mean larger by d, its variance
// would be larger by d k3 / k2. Its neighbours saw such values, and tell k3 / k2. Of two sides, k2
// is that of the one that may have missed them.

inline constexpr std::size_t sides_of_pair = 2;

// Deviations of single elements of single replicates from the element's mean. Large ones are
// counted in octaves, the 16 up to the largest. Some of them are rare in their element.
class PooledNoise {
 public:
  // Sums of powers of the deviations of some values.
  struct Powers {
    double count = 0;
    double squares = 0;
    double cubes = 0;
  };
  void add(const Powers& powers);
  // Takes a deviation, not 0, that is among those that are added. It is large beside what the other
  // elements mostly have.
  void add_large(double deviation, bool rare);
  // Takes an element with so many rare deviations that were added, and the size of the largest.
  void add_rare_element(double largest, double number);
  // Takes an element that varies; `noisier` if it has more relative variance than the other side's.
  void add_element(bool noisier);
  void merge(const PooledNoise& other);

  // Mean square and mean cube of the deviations cut off at +-2^octave, and of the rare ones alone.
  struct Moments {
    double second = 0;
    double third = 0;
  };
  enum class Signs { both, upward, downward };
  Moments cut_off(int octave) const;
  Moments rare_cut_off(int octave, Signs signs = Signs::both) const;
  static constexpr int octaves = 16;
  static constexpr int no_octave = -100'000;  // top() without any.
  int top() const { return top_; }            // No large deviation is beyond +-2^top.
  int bottom() const;                         // The lowest octave of a large one.
  // The lowest octave that is counted; large ones below are common.
  int lowest() const { return top_ == no_octave ? no_octave : top_ - octaves + 1; }
  double noisier() const { return noisier_; }
  // Number of rare deviations in this octave, and the squared numbers of those of the elements
  // whose largest is in it. One element with many tells as little of others as one with one.
  struct Rare {
    double count = 0;
    double squares = 0;
    friend bool operator==(const Rare&, const Rare&) = default;
  };
  Rare rare(int octave) const;

  // The square, summed over the elements, of the mean that each lacks if it missed the values that
  // carry the skewness in so many replicates. Those are taken to be of one size, as in a law of two
  // values.
  double hidden_squares(double replicates) const;

 private:
  // Number and sum of the sizes of some deviations.
  struct Pile {
    float count = 0;
    float sum = 0;
    void add(const Pile& other) {
      count += other.count;
      sum += other.sum;
    }
  };
  // An octave's piles.
  struct Bin {
    Pile large;
    Pile rare;
    float rare_squares = 0;
    void add(const Bin& other) {
      large.add(other.large);
      rare.add(other.rare);
      rare_squares += other.rare_squares;
    }
  };
  using Tail = std::array<Bin, octaves>;
  void raise(int top);
  // The powers of a pile's deviations, as if each were their mean.
  static Powers powers_of(std::size_t direction, const Pile& pile);
  // The moments of piles of these signs cut off, and of other deviations.
  Moments moments_of(Powers others, Pile Bin::*pile, int octave, Signs signs) const;

  Powers common_;  // Without the large, but for their count.
  double elements_ = 0;
  double noisier_ = 0;
  int top_ = no_octave;
  std::array<Tail, 2> tails_ = {};  // Upward, downward; from the top down.
};

// A cell's effect is the mean over the halves of its weighted mean of a - b.
struct CellNoise {
  double effect = 0;
  std::array<double, sides_of_pair> variance = {};  // Each side's part of the squared error.
  double degrees = 1;
  double third = 0;         // Third cumulant of the effect, of independent elements; 0 of few.
  double weights = 0;       // The mean over the halves of the weights' sum.
  bool alternates = false;  // Signs in turn.
  // The sum of the squared weights over the square of the weights' sum, between two sides with the
  // signs in turn. It is the mean of this over the halves, as is a reference's squared error. Both
  // are exact where the halves' weights are in proportion, and else too large.
  double concentration = 0;
};

// The noise of blocks of 8 x 8 elements, and of 2 x 2 blocks each up to the whole image.
class NoisePyramid {
 public:
  static constexpr std::size_t block = 8;

  NoisePyramid() = default;
  NoisePyramid(const ImageExtent& extent, std::array<std::size_t, sides_of_pair> replicates);

  // The block of 8 x 8 elements that holds this one.
  PooledNoise& at(std::size_t side, std::size_t x, std::size_t y, std::size_t channel) {
    return levels_[0].noise[side][levels_[0].index(x / block, y / block, channel)];
  }
  // Sums over elements, and over the aligned squares of sides 2, 4 and 8, of their squared weighted
  // deviations.
  using SquaresOfSides = std::array<double, 4>;
  void add_squares(std::size_t channel, const SquaresOfSides& squares);
  // To be called after the last element.
  void build();

  // The effect of a cell, for Student's t with the variance that it had if the means were equal.
  // For an effect of size d that is v + d k3 / k2, where k3 counts in the direction that makes the
  // effect smaller. The largest k3 / k2 counts, of the cell itself and of every block of four times
  // its side up to the whole image. A block's deviations are cut off at every octave, so that the
  // rarest do not drown the others. Its rare ones count by themselves too, so that the edge of a
  // lamp does not drown them. That is in octaves that two of the side reach that lacks light.
  //
  // Two sides of one law have one variance, which is pooled (Student 1908), unless Welch's is
  // larger. What few replicates of one missed the other shows. So the blocks count only where the
  // sides have different laws in one of them. That is where one is noisier for its mean in too many
  // elements (sign test). It is also where the darker has too many rare values beyond an octave, or
  // far too few. A reference has a law of its own, and what is held against it may lack values of
  // either sign: its rare ones of the other sign count as none. Skewness of the other side takes
  // away from k3, as far as the cell has it: by the part of a wide block's noise that this side has
  // in the cell.
  //
  // Neighbours' noise may move together, as where a filter spreads light. One rare value then moves
  // f elements of a cell, by the variances of cells over those of their elements (`together`).
  //
  // Between different laws a cell is no clearer than values allow that it never showed. They may be
  // three times as large as the noise of its neighbours.
  ImageEffect kept(const CellNoise& cell, const Rectangle& window, std::size_t channel) const;
  // The k3 / k2 of an effect of this sign.
  double growth(const CellNoise& cell, double sign, const Rectangle& window,
                std::size_t channel) const;

  // The squared bias, summed over the elements, that values can hide which they never showed in so
  // many times the replicates. In each block the larger side's counts.
  double hidden_squares(double times = 1) const;

 private:
  struct Level {
    std::size_t side = block;
    std::size_t width = 0;
    std::size_t height = 0;
    std::size_t channels = 1;
    std::array<std::vector<PooledNoise>, sides_of_pair> noise;
    std::size_t index(std::size_t x, std::size_t y, std::size_t channel) const {
      return (y * width + x) * channels + channel;
    }
  };
  struct Block {
    std::array<const PooledNoise*, sides_of_pair> sides;
    bool is_wide;  // It holds much beside the cell.
  };
  // The blocks around a cell, and the octaves that any of them tells apart.
  struct Around {
    std::vector<Block> blocks;
    int first = 0;
    int last = 0;
    double together = 1;  // In a block of 8 x 8.
  };
  Around around(const Rectangle& window, std::size_t channel) const;
  // The squares of a side over those of their elements, at least 1; for larger cells that of 8.
  double together(std::uint32_t side, std::size_t channel) const;
  // In a cell. With signs in turn, what moves together cancels.
  double together(const CellNoise& cell, const Rectangle& window, std::size_t channel) const {
    return cell.alternates ? 1 : together(std::max(window.width, window.height), channel);
  }
  double inverse(std::size_t side) const;  // 1 / replicates_, 0 of a reference.
  // The side that may have missed values: the darker, or the one beside a reference.
  std::size_t lacking(double toward) const { return toward > 0 || replicates_[1] == 0 ? 0 : 1; }
  bool of_one_law(const Around& near, double toward) const;
  // The k3 / k2 of a block of these moments. `parts` is how much of a block's noise each side has
  // in the cell itself.
  double growth(const std::array<PooledNoise::Moments, sides_of_pair>& here, double toward,
                const std::array<double, sides_of_pair>& parts) const;
  // ln p of an effect that values could explain which the cell never showed, three times as large
  // as the noise of its neighbours (constant_sample.h).
  double log_p_with_unseen(const ImageEffect& effect, double weights) const;
  // The k3 / k2 of one element, as the blocks tell it of an effect toward a side. None where the
  // sides are of one law.
  std::optional<double> growth_toward(const CellNoise& cell, const Around& near, double toward,
                                      double moved) const;
  double own_growth(const CellNoise& cell, double sign, const Rectangle& window,
                    std::size_t channel) const;
  std::optional<double> growth_of_blocks(const CellNoise& cell, double sign,
                                         const Rectangle& window, std::size_t channel) const;

  std::array<double, sides_of_pair> replicates_ = {};  // 0: no side, but a reference.
  std::vector<Level> levels_;
  std::vector<SquaresOfSides> squares_;  // By channel.
};

}  // namespace assay::stats
