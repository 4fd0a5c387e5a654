#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "stats/images/image.h"

namespace assay::stats {

struct Rectangle {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;

  std::size_t area() const { return std::size_t{width} * height; }
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// The sums of an image that are looked at. Level `size` has the cells of a grid of that size, the
// last cut off at the edge (aligned). It also has all other whole cells at steps of size / 4
// (shifted). A block of that size anywhere overlaps one of them by at least 49/64. Sizes are 1, 2,
// 4, … and the whole image. Beside them stands the whole image with alternating signs, by column,
// by row and as a checkerboard. Those find defects of interleaved samplers and threads, which every
// even-sized cell cancels.
enum class Grid { aligned, shifted, alternating };

struct WindowGroup {
  std::uint32_t size = 1;
  Grid grid = Grid::aligned;
  double share = 0;  // Share of the level.
  std::vector<Rectangle> windows;
};

// Share of the level for the sum over the whole image, which finds a uniform difference.
inline constexpr double whole_image_share = 0.4;

// The groups and their shares, which sum to 1. The three alternating sums have .025, all sizes but
// the whole image equal shares of the rest, halved between aligned and shifted cells. An image of
// one element has one group. Windows of sizes below `listed`, but for the whole image, are not
// listed: there are millions.
std::vector<WindowGroup> window_groups(const ImageExtent& extent, std::uint32_t listed = 1);

// Sums over rectangles of one channel by a summed-area table (Crow 1984), in double.
class WindowSums {
 public:
  explicit WindowSums(const ImageExtent& extent);

  // Takes values[y * width + x] of one channel.
  void load(std::span<const double> values);

  double of(const Rectangle& window) const;
  double of_all() const { return table_.back(); }

 private:
  std::size_t width_;
  std::vector<double> table_;  // (width + 1) x (height + 1).
};

// Direction in which an alternating sum changes its sign.
enum class Alternation { columns, rows, checkerboard };

// The mean difference at a place, weighted as the test weighs it.
struct ImageEffect {
  double estimate = 0;
  double standard_error = 0;
  double degrees = 1;

  double t() const { return estimate / standard_error; }
};

// The sums among which one was found, and their share of the level.
struct GroupSize {
  double count = 1;
  double share = 1;
};

// The most extreme statistic of a group: which sum, where, and how far from zero.
struct ImageFinding {
  std::optional<Alternation> alternation = {};  // None of a plain sum over the window.
  // Level: side of the cells. For alternating sums it is that of the image.
  std::uint32_t size = 1;
  Rectangle window;  // Around the elements of the sum that have a weight.
  std::size_t channel = 0;
  double z = 0;               // Positive where the first image is brighter.
  double log_p = 0;           // Of this one sum, two-sided.
  double adjusted_log_p = 0;  // In the family of everything that was looked at; at most 0.
  GroupSize group = {};
  ImageEffect effect = {};
};

// Adjusts one p-value for its group: ln(1 - (1 - p)^count) - ln share, at most 0.
double adjusted(double log_p, GroupSize group);

// The p-value that adjusted() turns into this one. Intervals of all cells at this level miss any of
// theirs with the level at most, so the one that was searched for does too.
double unadjusted(double log_p, GroupSize group);

// The noise of the mean difference in a typical aligned cell of this side: medians over cells.
// Smaller images have none.
inline constexpr std::uint32_t typical_side = 16;
struct CellNoiseOfMean {
  double variance = 0;
  double growth = 0;  // A difference of 1 adds this to the variance (image_noise.h).
};
// The standard error x of a difference of so many of them: x^2 = variance + errors x growth.
double standard_error_at(const CellNoiseOfMean& noise, double errors);

struct TypicalCell {
  GroupSize group = {};
  std::vector<CellNoiseOfMean> noise = {};  // By channel.
};

// An element that never varied, but differs from a reference or from the other image's constant.
// Unseen values may make up the difference (stats/means/constant_sample.h).
struct UnseenElement {
  std::size_t element = 0;
  double sign = 0;  // The sign of the difference.
  double log_p = 0;

  bool certain() const { return log_p == std::numeric_limits<double>::lowest(); }
  double z() const;  // The normal z of its p-value, with the difference's sign.
};

// All looks at a pair of images as one family. Sidak within a group of cells (1967; for two-sided
// tests of normal sums it holds under any correlation). Bonferroni across groups.
// P(log_p <= ln a) <= a.
struct ImageFamily {
  double log_p = 0;
  ImageFinding winner;
  std::vector<ImageFinding> groups;  // The best of each group, fine to coarse, then the others.
  // The cell of each group whose effect is the most standard errors. It tells the place: a p-value
  // also counts the degrees of freedom, and of clear effects these more than where they are.
  std::vector<ImageFinding> clearest = {};
  std::size_t tested = 0;           // Elements that vary, all channels.
  std::size_t equal_constants = 0;  // Also those that sums alone test.
  std::vector<UnseenElement> unseen = {};
  std::vector<float> weights;  // In sums, of the elements that vary or differ.
  // The squared norm of the bias that values can hide which their elements never showed
  // (image_noise.h), in units of the images.
  double hidden_squares = 0;
  double hidden_squares_of_twice = 0;  // With twice the replicates.
  TypicalCell typical = {};
};

// The interval at a finding's place has this confidence.
inline constexpr double confidence_at_place = 0.99;

// Sets the family's p-value, the smallest over the groups. The winner is the clearest of the cells
// that overlap the cell of this p-value and have its root or less. Their intervals must exclude 0
// where the family's p-value is as small. If a finer cell in it is as clear, that one wins:
// elements around it tell nothing. Signs in turn win only where there is no such cell.
void decide(ImageFamily& family);

// Leaves this share of the family's level to other tests: adjusted p-values grow. Decide after it.
void leave_share(ImageFamily& family, double share);

// Adds `unseen` to the groups, at 2 % of the level: the clearest, with those of its channel that
// are as clear. Decide after it.
void add_unseen(const ImageExtent& extent, ImageFamily& family);

// Certain differences have this z: no double is as small as the normal tail beyond.
inline constexpr double certain_z = 39;

}  // namespace assay::stats
