#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/images/image_windows.h"

namespace assay::stats {

enum class ImageStatistic { window, alternating, energy };

// Of an alternating sum: where its sign changes.
enum class Alternation { columns, rows, checkerboard };

// The most extreme statistic of a group: which sum it was, where, and how far from zero.
struct ImageFinding {
  ImageStatistic statistic = ImageStatistic::window;
  std::uint32_t size = 1;  // level: side of the cells; that of the image for the other statistics
  Rectangle window;
  std::size_t channel = 0;
  double z = 0;      // signed, positive where the first image is brighter; of the energy: one-sided
  double log_p = 0;  // two-sided (energy: upper tail), of this one sum
  double adjusted_log_p = 0;  // in the family of everything that was looked at; below 0 or 0
  Alternation alternation = Alternation::columns;
};

// All looks at a pair of images as one family: Sidak within a group of cells (1967: for two-sided
// tests of normal sums the inequality holds under any correlation), Bonferroni across groups,
// channels of the energy, and statistics. P(log_p <= ln a) <= a.
struct ImageFamily {
  double log_p = 0;
  ImageFinding winner;
  std::vector<ImageFinding> groups;  // the best of each group, fine to coarse, then the others
  std::size_t tested = 0;            // elements that vary, all channels
  std::size_t equal_constants = 0;
  std::size_t different_constants = 0;
};

// Share of the level that goes to the energy, sum z^2; the rest goes to the windows.
inline constexpr double energy_share = 0.15;

// ln(1 - (1 - p)^count) - ln share, at most 0.
struct GroupSize {
  double count = 1;
  double share = 1;
};
double adjusted(double log_p, GroupSize group);

// min over the groups.
void decide(ImageFamily& family);

// Cells smaller than this leave the family, and the energy where it is to; certain differences do
// not.
struct LeftOut {
  std::uint32_t smallest = 1;
  bool energy = false;
};
void leave_out(ImageFamily& family, LeftOut which);

// The energy by a p-value found elsewhere, of flips of signs for one, joins the family.
// energy_notice: ln of the p-value below which it would be the family's smallest, the only one that
// counts. Whoever cannot get below it need not look.
void add_energy(ImageFamily& family, const ImageExtent& extent, double log_p);
double energy_notice(const ImageFamily& family);

// A finding that has no place: the whole image.
ImageFinding whole_image(ImageStatistic statistic, const ImageExtent& extent);

// A finding without chance: different constants.
ImageFinding certain_finding(const ImageExtent& extent, std::size_t element, double sign);

}  // namespace assay::stats
