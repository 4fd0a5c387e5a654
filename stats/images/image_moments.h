#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/basics/moments.h"
#include "stats/images/image.h"
#include "stats/means/student_t.h"

namespace assay::stats {

// ---- Moments of elements over images

// Views of two arrays of one size that receive the moments of a range of elements.
struct MomentArrays {
  std::span<double> mean = {};
  std::span<double> m2 = {};

  // The part for these elements; none if there is no room for any.
  MomentArrays part(std::size_t first, std::size_t size) const {
    if (mean.empty()) return {};
    return {mean.subspan(first, size), m2.subspan(first, size)};
  }
};

// Mean and sum of squared deviations of each of the elements [first, first + mean.size()). They are
// over every `step`-th image from `start` on, all in memory. Deviations are taken from the first of
// these images. It belongs to the sample, so sum d^2 <= (n + 1) m2 and subtracting costs at most
// n + 1 roundings. So m2 is exactly zero for constants and only for them.
struct EveryImage {
  std::size_t start = 0;
  std::size_t step = 1;
};
void moments_of_range(const ImageStack& stack, std::size_t first, MomentArrays out,
                      EveryImage which = {});

// Moments up to order four of the elements [first, first + out.size()) over the images of a stack.
// Two passes over pieces that stay in the cache: first moments_of_range, then higher powers of the
// deviations from its means. An element that never varied has m2 = 0 exactly. Each element's
// moments depend on its own values alone, so a caller may split the elements in any way. A
// non-finite value makes its element's m2 non-finite.
void element_moments(const ImageStack& stack, std::size_t first, std::span<Moments> out);

// The finite values of every element over the images, at least one, and which were not finite. The
// same bits as for any split of the elements.
std::vector<FiniteMoments> finite_moments(const ImageStack& stack,
                                          const ForEach& for_each = one_by_one);

// Extremes over some elements.
struct Extremes {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;  // Values that are not zero.

  void merge(const Extremes& other);
  // Takes values, all of them finite.
  void add(std::span<const float> values);
};

// ---- Sums of images over their elements

// Sums of the channels of numbers that follow on each other. Each channel's go in turn to 32 sums,
// so that few additions wait for the last. Any portions give the same bits.
class ChannelSums {
 public:
  explicit ChannelSums(std::size_t channels);

  void add(std::span<const float> numbers);
  std::vector<double> sums() const;

 private:
  std::size_t channels_;
  std::vector<double> in_turn_;
  std::size_t next_ = 0;
};

// The sums of each image's channels, those of an image together.
std::vector<double> image_channel_sums(const ImageStack& stack,
                                       const ForEach& for_each = one_by_one);

// ---- Means over an image

// The mean of each channel over all columns and rows, with its standard error.
using ChannelMeans = std::vector<Reference>;

// Means of replicates. Their spread shows how far an image's elements depend on each other.
ChannelMeans channel_means(const ImageStack& stack, const ForEach& for_each = one_by_one);

// The same from the sums of image_channel_sums.
ChannelMeans channel_means(std::span<const double> sums, const ImageExtent& extent);

// Means of numbers whose errors are independent between elements.
ChannelMeans channel_means(const ImageReference& reference);

// Central interval of the mean of all elements, of replicates with independent elements but for the
// channels of one place. The standard deviation of their sum is at most the sum of theirs: the
// interval can be too wide, not too narrow. Degrees of freedom by Satterthwaite (1946). Nothing if
// an element has fewer than two values, or nothing varies.
std::optional<Interval> interval_of_mean(const ImageExtent& extent,
                                         const std::function<Moments(std::size_t element)>& moments,
                                         double mean, double confidence);

// Makes means the unit of something else.
void drop_errors(ChannelMeans& means);

// By channel, standard errors of a difference that is the same everywhere.
std::vector<double> uniform_errors(const ChannelMeans& first, const ChannelMeans& second);

// The least of the errors of channels that vary: absolute, or as a part of the channel's mean.
double least_error(std::span<const double> errors, const ChannelMeans& means, bool relative);

}  // namespace assay::stats
