#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/pyramids/image_noise.h"

namespace assay::stats {

// Internal to image_pyramid: Welch's statistic of the mean difference of many cells. Replicates
// come in parts, the halves of either side. Each part has means and variances of its own. The
// difference is the sum over the parts of factor * mean.
struct WelchCells {
  // The current part: mean and sum of squared deviations of each cell's sums (Welford 1962).
  std::vector<double> mean;
  std::vector<double> m2;
  // The parts that are done.
  std::vector<double> effect;                               // Estimate of a - b.
  std::array<std::vector<double>, sides_of_pair> variance;  // Its squared error, by side.
  std::vector<double> reciprocal_degrees;       // Sum of variance_g^2 / (n_g - 1) over the parts.
  std::vector<unsigned char> halves_that_vary;  // A bit each.

  void start(std::size_t cells);
  // The replicates since the last call are a part of that half and side. Its mean enters with this
  // factor.
  void finish_part(std::size_t half, std::size_t side, double count, double factor);

  // Sums that did not vary in both halves are too little known to be tested.
  bool varied(std::size_t cell) const { return halves_that_vary[cell] == 3; }
  // Sets effect, variance and degrees.
  void put(std::size_t cell, CellNoise& noise) const;
};

}  // namespace assay::stats
