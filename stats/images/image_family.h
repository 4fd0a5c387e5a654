#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/images/image_windows.h"

namespace assay::stats {

enum class ImageStatistic { window, alternating };

// Direction in which an alternating sum changes its sign.
enum class Alternation { columns, rows, checkerboard };

// The mean difference at a place, weighted as the test weighs it.
struct ImageEffect {
  double estimate = 0;
  double standard_error = 0;
  double degrees = 1;
};

// The most extreme statistic of a group: which sum, where, and how far from zero.
struct ImageFinding {
  ImageStatistic statistic = ImageStatistic::window;
  // Level: side of the cells. For alternating sums it is that of the image.
  std::uint32_t size = 1;
  Rectangle window;
  std::size_t channel = 0;
  double z = 0;               // Positive where the first image is brighter.
  double log_p = 0;           // Of this one sum, two-sided.
  double adjusted_log_p = 0;  // In the family of everything that was looked at; at most 0.
  Alternation alternation = Alternation::columns;
  ImageEffect effect = {};
};

// All looks at a pair of images as one family. Sidak within a group of cells (1967; for two-sided
// tests of normal sums it holds under any correlation). Bonferroni across groups.
// P(log_p <= ln a) <= a.
struct ImageFamily {
  double log_p = 0;
  ImageFinding winner;
  std::vector<ImageFinding> groups;  // The best of each group, fine to coarse, then the others.
  std::size_t tested = 0;            // Elements that vary, all channels.
  std::size_t equal_constants = 0;   // Also those that sums alone test.
  std::size_t different_constants = 0;
  std::vector<float> weights;  // The elements' in sums.
  // The squared norm of the bias that values can hide which their elements never showed
  // (image_noise.h), in units of the images.
  double hidden_squares = 0;
};

// Adjusts one p-value for its group: ln(1 - (1 - p)^count) - ln share, at most 0.
struct GroupSize {
  double count = 1;
  double share = 1;
};
double adjusted(double log_p, GroupSize group);

// Sets the family's p-value, the smallest over the groups.
void decide(ImageFamily& family);

// A certain finding: different constants.
ImageFinding certain_finding(const ImageExtent& extent, std::size_t element, double sign);

}  // namespace assay::stats
