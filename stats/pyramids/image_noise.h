#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/images/image.h"
#include "stats/images/image_windows.h"

namespace assay::stats {

// Internal to image_pyramid: what neighbours tell of the noise of a cell.
//
// A cell of a few replicates may have missed the rare bright values that carry part of its mean.
// Then its mean is too low, and its variance says that it is exact. Its neighbours saw such values.

inline constexpr std::size_t sides_of_pair = 2;

// The direction of a deviation, and of a tail.
inline constexpr std::size_t upward = 0;
inline constexpr std::size_t downward = 1;
inline constexpr std::size_t directions = 2;
// The largest deviation of a cell's elements, in either direction.
using Largest = std::array<float, directions>;

// Deviations of single elements of single replicates from the element's mean, in units of the
// weights. Beyond least_rare they are counted in bins, two an octave.
class PooledNoise {
 public:
  static constexpr float least_rare = 2;

  // An element's replicates in units of the weights.
  struct Element {
    double replicates = 0;
    double sum_of_squares = 0;  // Of deviations.
    double mean = 0;
  };
  void add_element(const Element& element);
  // Takes one deviation x with |x| > least_rare of an element that was added.
  void add_rare(float deviation);
  // Takes the largest deviations of one element of all replicates.
  void add_largest(const Largest& largest);
  void merge(const PooledNoise& other);

  // The law of min(x, c) and of (x - c)+ in one direction, where c >= least_rare.
  struct Tail {
    double excess = 0;  // Mean of (x - c)+.
    double excess_variance = 0;
    double square = 0;  // Mean of min(x, c)^2.
    double square_variance = 0;
  };
  Tail beyond(std::size_t direction, double c) const;
  // Mean of an element's largest deviation, or least_rare.
  double usual_largest(std::size_t direction) const;
  // Mean over the elements of variance / mean^2 of one replicate.
  double relative_variance() const;

 private:
  static constexpr std::size_t bins = 24;
  struct Bin {
    float count = 0;
    float sum = 0;
  };
  double count_ = 0;
  double squares_ = 0;
  double elements_ = 0;
  double lit_ = 0;  // Number of elements whose mean is above 0.
  double relative_variances_ = 0;
  std::array<double, directions> largest_ = {};  // Sums over the elements.
  std::array<std::array<Bin, bins>, directions> rare_;
};

// A cell's sums, averaged over the halves, and what its elements showed.
struct CellNoise {
  double effect = 0;                                // Estimate of the sum of a - b.
  std::array<double, sides_of_pair> level = {};     // Either side's own sum.
  std::array<double, sides_of_pair> variance = {};  // What either side adds to its squared error.
  double degrees = 1;
  double more = 0;   // What its elements add if each is as bright as on the other side.
  double third = 0;  // Third cumulant of the effect, of independent elements; 0 of few.
  double elements = 0;
  std::array<Largest, sides_of_pair> largest = {};
};

// What an element adds to its cell's variance if it is as bright as on the other side.
double variance_of_missing_light(const CellNoise& element);

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
  // To be called after the last element.
  void build();

  // The statistic of a cell: Student's t that survives what its neighbours know.
  //
  // Noise grows with light. Were the darker side as bright as the other, its standard error would
  // be larger in proportion. That error counts: the cell's, or that of its elements if they make up
  // more. An element's own counts from where the sides differ by an error of each. A cell that is 0
  // throughout has its neighbours' relative variance. (Sums below 0 are no light, and nothing is
  // done.)
  //
  // Let c be the cell's own largest deviation, and e the mean of (x - c)+ over the noise of a block
  // around it. The cell lacks e if it missed all larger values. Where one side lacks more than the
  // other, 3 (e_a - e_b - 1 error) is taken off the effect. That is done for every block from four
  // times the cell's side up to the whole image. A side also lacks variance if values below c have
  // more of it in the block. What one side lacks beyond the other and 2 errors is added. Two sides
  // of one law lack the same, and nothing changes.
  //
  // A cell with a third cumulant takes Hall's correction for skewness (1992, J. R. Statist. Soc. B
  // 54, 221) where it shrinks t. Beyond the point where it grows again t is cut off.
  struct Kept {
    double t = 0;
    double margin = 0;          // What was taken off the effect.
    double standard_error = 0;  // With the variance of the neighbours.
  };
  Kept kept(const CellNoise& cell, const Rectangle& window, std::size_t channel) const;

  // The bias of an element, in units of the weights, that values can hide which it never showed.
  // Its block shows them beyond the usual largest deviation: upward of one side and downward of the
  // other. The larger sum counts.
  double hidden(std::size_t x, std::size_t y, std::size_t channel) const;

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
  double variance_if_equal(const CellNoise& cell, const Rectangle& window,
                           std::size_t channel) const;

  std::array<double, sides_of_pair> replicates_ = {};  // 0: no side, but a reference.
  std::vector<Level> levels_;
};

}  // namespace assay::stats
