#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/images/image_windows.h"

namespace assay::stats {

enum class ImageStatistic { window, alternating, energy };

// Direction in which an alternating sum changes its sign.
enum class Alternation { columns, rows, checkerboard };

// The most extreme statistic of a group: which sum, where, and how far from zero.
struct ImageFinding {
  ImageStatistic statistic = ImageStatistic::window;
  // Level: side of the cells. For the other statistics it is that of the image.
  std::uint32_t size = 1;
  Rectangle window;
  std::size_t channel = 0;
  double z = 0;      // Positive where the first image is brighter. For the energy one-sided.
  double log_p = 0;  // Of this one sum: two-sided, for the energy the upper tail.
  double adjusted_log_p = 0;  // In the family of everything that was looked at; at most 0.
  Alternation alternation = Alternation::columns;
};

// All looks at a pair of images as one family. Sidak within a group of cells (1967; for two-sided
// tests of normal sums it holds under any correlation). Bonferroni across groups, channels of the
// energy, and statistics. P(log_p <= ln a) <= a.
struct ImageFamily {
  double log_p = 0;
  ImageFinding winner;
  std::vector<ImageFinding> groups;  // The best of each group, fine to coarse, then the others.
  std::size_t tested = 0;            // Elements that vary, all channels.
  std::size_t equal_constants = 0;
  std::size_t different_constants = 0;
};

// Share of the level for the energy, sum z^2. The rest goes to the windows.
inline constexpr double energy_share = 0.15;

// Adjusts one p-value for its group: ln(1 - (1 - p)^count) - ln share, at most 0.
struct GroupSize {
  double count = 1;
  double share = 1;
};
double adjusted(double log_p, GroupSize group);

// Sets the family's p-value, the smallest over the groups.
void decide(ImageFamily& family);

// Removes cells smaller than `smallest` from the family, and the energy if asked. Certain
// differences stay.
struct LeftOut {
  std::uint32_t smallest = 1;
  bool energy = false;
};
void leave_out(ImageFamily& family, LeftOut which);

// The energy joins the family by a p-value found elsewhere, such as from sign flips. Only a p-value
// below energy_notice (ln p) would be the family's smallest. Any other changes nothing.
void add_energy(ImageFamily& family, const ImageExtent& extent, double log_p);
double energy_notice(const ImageFamily& family);

// A finding that has no place: the whole image.
ImageFinding whole_image(ImageStatistic statistic, const ImageExtent& extent);

// A certain finding: different constants.
ImageFinding certain_finding(const ImageExtent& extent, std::size_t element, double sign);

}  // namespace assay::stats
