#include "stats/images/image_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/basics/vector_copies.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// ---- Mean and squares, four images a pass

// The sums of this many elements stay in the first-level cache while the images pass by.
constexpr std::size_t elements_at_once = 1024;

// Four images a pass: sums are loaded and stored once for all four.
ASSAY_VECTOR_COPIES void add_four(const float* origin, const std::array<const float*, 4>& image,
                                  double* to_sum, double* to_squares, std::size_t size) {
  const float* const a = image[0];
  const float* const b = image[1];
  const float* const c = image[2];
  const float* const d = image[3];
  double* const __restrict sum = to_sum;
  double* const __restrict squares = to_squares;
  for (std::size_t i = 0; i < size; ++i) {
    const double zero = static_cast<double>(origin[i]);
    const double p = static_cast<double>(a[i]) - zero;
    const double q = static_cast<double>(b[i]) - zero;
    const double r = static_cast<double>(c[i]) - zero;
    const double s = static_cast<double>(d[i]) - zero;
    sum[i] += (p + q) + (r + s);
    squares[i] += (p * p + q * q) + (r * r + s * s);
  }
}

// The origin itself, which adds nothing, fills up the last four images.
void two_moments_of_block(const ImageStack& stack, std::size_t first, MomentArrays out,
                          EveryImage which) {
  std::array<double, elements_at_once> sum{};
  std::array<double, elements_at_once> squares{};
  const std::size_t size = out.mean.size();
  const auto& images = stack.images;
  const float* const origin = stack.at(which.start, first);
  std::size_t count = 1;
  for (std::size_t i = which.start + which.step; i < images.size();) {
    std::array<const float*, 4> four{origin, origin, origin, origin};
    for (std::size_t k = 0; k < 4 && i < images.size(); ++k, i += which.step, ++count) {
      four[k] = stack.at(i, first);
    }
    add_four(origin, four, sum.data(), squares.data(), size);
  }
  const double inverse = 1 / static_cast<double>(count);
  for (std::size_t i = 0; i < size; ++i) {
    const double step = sum[i] * inverse;
    out.mean[i] = static_cast<double>(origin[i]) + step;
    out.m2[i] = std::max(squares[i] - sum[i] * step, 0.0);
  }
}

// ---- Four moments in two passes

// The sums of this many elements, and their values in a hundred images, stay in the cache.
constexpr std::size_t block_size = 512;
using Block = std::array<double, block_size>;

struct Sums {
  Block mean{};
  Block m2{};
  Block m3{};
  Block m4{};
  Block minimum{};
  Block maximum{};
  Block nonzero{};
};

ASSAY_VECTOR_COPIES void add_powers(const float* values, Sums& sums, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    const double value = static_cast<double>(values[i]);
    const double deviation = value - sums.mean[i];
    const double square = deviation * deviation;
    sums.m3[i] += square * deviation;
    sums.m4[i] += square * square;
    sums.minimum[i] = value < sums.minimum[i] ? value : sums.minimum[i];
    sums.maximum[i] = value > sums.maximum[i] ? value : sums.maximum[i];
    sums.nonzero[i] += value != 0 ? 1.0 : 0.0;
  }
}

void moments_of_block(const ImageStack& stack, std::size_t first, std::span<Moments> out) {
  Sums sums;
  moments_of_range(stack, first,
                   {std::span(sums.mean).first(out.size()), std::span(sums.m2).first(out.size())});
  const float* const origin = stack.at(0, first);
  for (std::size_t i = 0; i < out.size(); ++i) {
    sums.minimum[i] = static_cast<double>(origin[i]);
    sums.maximum[i] = static_cast<double>(origin[i]);
  }
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    add_powers(stack.at(r, first), sums, out.size());
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {.count = stack.images.size(),
              .mean = sums.mean[i],
              .m2 = sums.m2[i],
              .m3 = sums.m3[i],
              .m4 = sums.m4[i],
              .minimum = sums.minimum[i],
              .maximum = sums.maximum[i],
              .nonzero = static_cast<std::uint64_t>(sums.nonzero[i])};
  }
}

// ---- Sums of images

// Adds up numbers that are sums.size() apart.
ASSAY_VECTOR_COPIES void add_apart(std::span<const float> numbers, std::span<double> sums) {
  const std::size_t apart = sums.size();
  double* const __restrict sum = sums.data();
  for (std::size_t i = 0; i < numbers.size(); i += apart) {
    for (std::size_t k = 0; k < apart; ++k) sum[k] += static_cast<double>(numbers[i + k]);
  }
}

constexpr std::size_t sums_of_channel = 32;

}  // namespace

void moments_of_range(const ImageStack& stack, std::size_t first, MomentArrays out,
                      EveryImage which) {
  for (std::size_t done = 0; done < out.mean.size(); done += elements_at_once) {
    const std::size_t size = std::min(elements_at_once, out.mean.size() - done);
    two_moments_of_block(stack, first + done, out.part(done, size), which);
  }
}

void element_moments(const ImageStack& stack, std::size_t first, std::span<Moments> out) {
  check::at_least({"element_moments", "images"}, stack.images.size(), 1);
  for (const auto& image : stack.images) {
    check::at_least({"element_moments", "size of an image"}, image.size() + stack.there.first,
                    first + out.size());
  }
  for (std::size_t done = 0; done < out.size(); done += block_size) {
    const std::size_t size = std::min(block_size, out.size() - done);
    moments_of_block(stack, first + done, out.subspan(done, size));
  }
}

std::vector<FiniteMoments> finite_moments(const ImageStack& stack, const ForEach& for_each) {
  constexpr std::size_t at_a_time = 4096;
  const std::size_t elements = stack.extent.elements();
  std::vector<FiniteMoments> all(elements);
  for_each((elements + at_a_time - 1) / at_a_time, [&](std::size_t part) {
    const std::size_t first = part * at_a_time;
    std::vector<Moments> moments(std::min(at_a_time, elements - first));
    element_moments(stack, first, moments);
    for (std::size_t i = 0; i < moments.size(); ++i) {
      FiniteMoments& out = all[first + i];
      if (std::isfinite(moments[i].m2)) {
        out.moments = moments[i];
        continue;
      }
      for (std::size_t k = 0; k < stack.images.size(); ++k) out.add(*stack.at(k, first + i), k);
    }
  });
  return all;
}

void Extremes::add(std::span<const float> values) {
  // So many numbers have extremes of their own, so that none waits for the last.
  constexpr std::size_t apart = 32;
  std::array<float, apart> low;
  std::array<float, apart> high;
  std::array<std::uint32_t, apart> not_zero{};
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  const auto take = [&](float value, std::size_t k) {
    low[k] = value < low[k] ? value : low[k];
    high[k] = value > high[k] ? value : high[k];
    not_zero[k] += value != 0 ? 1 : 0;
  };
  const std::size_t whole = values.size() / apart * apart;
  for (std::size_t i = 0; i < whole; i += apart) {
    for (std::size_t k = 0; k < apart; ++k) take(values[i + k], k);
  }
  for (std::size_t i = whole; i < values.size(); ++i) take(values[i], i - whole);
  minimum = std::min(minimum, double{*std::ranges::min_element(low)});
  maximum = std::max(maximum, double{*std::ranges::max_element(high)});
  nonzero += std::accumulate(not_zero.begin(), not_zero.end(), std::uint64_t{0});
}

void Extremes::merge(const Extremes& other) {
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  nonzero += other.nonzero;
}

ChannelSums::ChannelSums(std::size_t channels)
    : channels_(channels), in_turn_(sums_of_channel * channels) {}

void ChannelSums::add(std::span<const float> numbers) {
  const auto one_by_one = [&](std::span<const float> some) {
    for (const float number : some) {
      in_turn_[next_] += static_cast<double>(number);
      next_ = (next_ + 1) % in_turn_.size();
    }
  };
  const std::size_t begun = std::min(numbers.size(), (in_turn_.size() - next_) % in_turn_.size());
  one_by_one(numbers.first(begun));
  const std::size_t whole = (numbers.size() - begun) / in_turn_.size() * in_turn_.size();
  add_apart(numbers.subspan(begun, whole), std::span(in_turn_));
  one_by_one(numbers.subspan(begun + whole));
}

std::vector<double> ChannelSums::sums() const {
  std::vector<double> sums(channels_);
  for (std::size_t i = 0; i < in_turn_.size(); ++i) sums[i % channels_] += in_turn_[i];
  return sums;
}

std::vector<double> image_channel_sums(const ImageStack& stack, const ForEach& for_each) {
  const std::size_t channels = stack.extent.channels;
  std::vector<double> sums(stack.images.size() * channels);
  for_each(stack.images.size(), [&](std::size_t i) {
    ChannelSums of_image(channels);
    of_image.add(stack.images[i]);
    std::ranges::copy(of_image.sums(), sums.begin() + static_cast<std::ptrdiff_t>(i * channels));
  });
  return sums;
}

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
