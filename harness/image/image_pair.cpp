#include "harness/image/image_pair.h"

#include <cmath>
#include <functional>
#include <limits>

#include "harness/base/parallel.h"
#include "stats/basics/moments.h"
#include "stats/images/image_moments.h"

namespace assay::harness {
namespace {

/// c y + b, to which E x is compared.
struct Mapping {
  double factor;
  double offset;
  bool changes() const { return factor != 1 || offset != 0; }
  double operator()(double value) const { return factor * value + offset; }
};

std::vector<std::vector<float>> mapped(const std::vector<std::span<const float>>& images,
                                       const Mapping& mapping) {
  std::vector<std::vector<float>> copies;
  for (const std::span<const float> image : images) {
    std::vector<float>& copy = copies.emplace_back(image.begin(), image.end());
    for (float& value : copy) value = static_cast<float>(mapping(value));
  }
  return copies;
}

}  // namespace

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

ImagePair::ImagePair(const Seen& seen) {
  const Question& question = seen.question;
  const stats::ImageExtent extent = extent_of(*question.subjects[0].image);
  first = {extent, seen.data[0].images.images()};
  if (question.of_two()) {
    const Mapping mapping{question.factor, question.offset};
    const ImageViews& other = seen.data[1].images;
    if (mapping.changes()) scaled_ = ImageViews(mapped(other.images(), mapping));
    second = {extent, (mapping.changes() ? scaled_ : other).images()};
    if (!question.is().of_pairs) return;
    subtracted.swap(second);
    first = difference(first, *subtracted, differences_);
    value.assign(extent.elements(), 0);
    return;
  }
  value.reserve(extent.elements());
  for (const Constant& reference : question.references) {
    value.push_back(reference.value + question.offset);
  }
  const bool exact = std::ranges::all_of(
      question.references, [](const Constant& each) { return each.standard_error == 0; });
  if (exact) return;
  for (const Constant& reference : question.references) error.push_back(reference.standard_error);
}

stats::ImageStack difference(const stats::ImageStack& one, const stats::ImageStack& other,
                             std::vector<float>& texels) {
  stats::ImageStack differences{one.extent, {}, one.there};
  const std::size_t count = std::min(one.images.size(), other.images.size());
  const std::size_t size = count == 0 ? 0 : one.images[0].size();
  texels.resize(count * size);
  for (std::size_t i = 0; i < count; ++i) {
    differences.images.push_back(std::span(texels).subspan(i * size, size));
  }
  on_all_threads(count, [&](std::size_t i) {
    std::ranges::transform(one.images[i], other.images[i],
                           texels.begin() + static_cast<std::ptrdiff_t>(i * size), std::minus<>());
  });
  return differences;
}

ChannelMeans channel_means(const stats::ImageStack& stack) {
  return channel_means(stats::image_channel_sums(stack, on_all_threads), stack.extent);
}

ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent) {
  const auto pixels = static_cast<double>(extent.width * extent.height);
  ChannelMeans means;
  for (std::size_t c = 0; c < extent.channels; ++c) {
    stats::Moments moments;
    for (std::size_t i = c; i < sums.size(); i += extent.channels) moments.add(sums[i] / pixels);
    means.push_back({moments.mean, moments.standard_error()});
  }
  return means;
}

ChannelMeans channel_means(const stats::ImageReference& reference) {
  const std::size_t channels = reference.extent.channels;
  const auto pixels = static_cast<double>(reference.extent.width * reference.extent.height);
  ChannelMeans means(channels);
  for (std::size_t i = 0; i < reference.value.size(); ++i) {
    Constant& mean = means[i % channels];
    mean.value += reference.value[i] / pixels;
    if (reference.standard_error.empty()) continue;
    mean.standard_error = std::hypot(mean.standard_error, reference.standard_error[i] / pixels);
  }
  return means;
}

std::vector<double> uniform_errors(const ChannelMeans& first, const ChannelMeans& second) {
  std::vector<double> errors;
  for (std::size_t c = 0; c < first.size(); ++c) {
    errors.push_back(std::hypot(first[c].standard_error, second[c].standard_error));
  }
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

}  // namespace assay::harness
