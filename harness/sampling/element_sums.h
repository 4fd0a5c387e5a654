#pragma once

// What is kept of pictures of millions of elements, from reading their rows once.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "stats/basics/moments.h"
#include "stats/images/image.h"

namespace assay::harness {

/// Of every element of pictures the moments that maps show; all values are finite.
struct ElementSums {
  std::uint64_t count = 0;  ///< of pictures
  std::vector<double> mean = {};
  std::vector<double> m2 = {};
  stats::Moments first = {};    ///< of the first element everything, for who asks of one
  stats::Moments average = {};  ///< of the pictures' averages
  double minimum = std::numeric_limits<double>::infinity();  ///< over all elements
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;  ///< values of all elements

  /// Of an element, or of the average, which comes after them.
  stats::Moments moments(std::size_t channel) const;
};

/// Of two stacks of pictures the sums of elements, rows after rows, and what they say together.
class SumsOfTwo {
 public:
  SumsOfTwo(const stats::ImageExtent& extent, std::uint64_t pictures);

  /// Rows that follow on those before.
  void take(const stats::ImagePair<float>& pair, stats::RowRange rows);
  /// After the last rows, with the averages of either side's pictures.
  std::vector<ElementSums> finish(std::span<const std::vector<double>> averages);
  /// Mean over the elements that vary of |skewness of one picture's difference|.
  double skewness() const;
  /// Whether moments can be made of the numbers of every element that is not constant.
  bool sound() const { return sound_; }

 private:
  stats::ImageExtent extent_;
  std::vector<ElementSums> sides_;
  double skewness_ = 0;
  double varying_ = 0;  // elements that it is the sum over
  bool sound_ = true;
};

}  // namespace assay::harness
