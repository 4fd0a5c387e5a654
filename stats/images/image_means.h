#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "stats/images/image_moments.h"
#include "stats/means/student_t.h"

namespace assay::stats {

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
