#include "stats/images/image_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/tails/tails.h"

namespace assay::stats {

ChannelMeans channel_means(const ImageStack& stack, const ForEach& for_each) {
  return channel_means(image_channel_sums(stack, for_each), stack.extent);
}

ChannelMeans channel_means(std::span<const double> sums, const ImageExtent& extent) {
  const auto places = static_cast<double>(extent.width * extent.height);
  ChannelMeans means;
  for (std::size_t c = 0; c < extent.channels; ++c) {
    Moments moments;
    for (std::size_t i = c; i < sums.size(); i += extent.channels) moments.add(sums[i] / places);
    means.push_back({moments.mean, moments.standard_error()});
  }
  return means;
}

ChannelMeans channel_means(const ImageReference& reference) {
  const std::size_t channels = reference.extent.channels;
  const auto places = static_cast<double>(reference.extent.width * reference.extent.height);
  ChannelMeans means(channels);
  for (std::size_t i = 0; i < reference.value.size(); ++i) {
    Reference& mean = means[i % channels];
    mean.value += reference.value[i] / places;
    if (reference.standard_error.empty()) continue;
    mean.standard_error = std::hypot(mean.standard_error, reference.standard_error[i] / places);
  }
  return means;
}

std::optional<Interval> interval_of_mean(const ImageExtent& extent,
                                         const std::function<Moments(std::size_t element)>& moments,
                                         double mean, double confidence) {
  double sum = 0;
  double squares = 0;
  for (std::size_t first = 0; first < extent.elements(); first += extent.channels) {
    double deviation = 0;
    for (std::size_t c = 0; c < extent.channels; ++c) {
      const Moments x = moments(first + c);
      if (x.count < 2) return std::nullopt;
      deviation += std::sqrt(x.variance());
    }
    const double square = deviation * deviation;
    sum += square;
    squares += square * square;
  }
  if (!(sum > 0) || !std::isfinite(squares) || !(squares > 0)) return std::nullopt;
  const auto count = static_cast<double>(moments(0).count);
  const double degrees = sum * sum / squares * (count - 1);
  const double error = std::sqrt(sum / count) / static_cast<double>(extent.elements());
  const double half =
      error * student_t_quantile({Tail::upper, std::log((1 - confidence) / 2)}, degrees);
  return Interval{mean - half, mean + half, confidence};
}

void drop_errors(ChannelMeans& means) {
  for (Reference& mean : means) mean.standard_error = 0;
}

std::vector<double> uniform_errors(const ChannelMeans& first, const ChannelMeans& second) {
  std::vector<double> errors(first.size());
  std::ranges::transform(first, second, errors.begin(), [](const Reference& a, const Reference& b) {
    return std::hypot(a.standard_error, b.standard_error);
  });
  return errors;
}

double least_error(std::span<const double> errors, const ChannelMeans& means, bool relative) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (!(errors[c] > 0)) continue;
    least = std::min(least, relative ? errors[c] / std::abs(means[c].value) : errors[c]);
  }
  return least;
}

}  // namespace assay::stats
