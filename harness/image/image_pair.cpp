#include "harness/image/image_pair.h"

#include <algorithm>
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
};

Mapping mapping_of(const Question& question, std::size_t subject) {
  return subject == 0 || !question.of_two() ? Mapping{1, 0}
                                            : Mapping{question.factor, question.offset};
}

ImageViews mapped(const ImageViews& views, const Mapping& mapping) {
  std::vector<std::vector<double>> copies;
  views.with([&](const auto& images) {
    for (const auto& image : images) {
      std::vector<double>& copy = copies.emplace_back(image.begin(), image.end());
      for (double& value : copy) value = mapping.factor * value + mapping.offset;
    }
  });
  return ImageViews(std::move(copies));
}

template <class Real>
const ImageViews::Images<Real>& images_of(const ImageViews& views, const Mapping& mapping,
                                          ImageViews& made) {
  if (mapping.changes()) {
    made = mapped(views, mapping);
  } else if (views.single_precision() && !std::is_same_v<Real, float>) {
    made = widened(views.images<float>());
  } else {
    return views.images<Real>();
  }
  return made.images<Real>();
}

}  // namespace

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

template <class Real>
ImagePair<Real>::ImagePair(const Seen& seen) {
  const Question& question = seen.question;
  const auto stack = [&](std::size_t side) {
    return stats::ImageStack<Real>{
        extent_of(*question.subjects[0].image),
        images_of<Real>(seen.data[side].images, mapping_of(question, side), made_[side])};
  };
  this->first = stack(0);
  if (question.of_two()) {
    this->second = stack(1);
    if (!question.is().of_pairs) return;
    subtracted.swap(this->second);
    this->first = difference(this->first, *subtracted, differences_);
    this->value.assign(this->first.extent.elements(), 0);
    return;
  }
  for (const Constant& reference : question.references) {
    this->value.push_back(reference.value + question.offset);
    this->error.push_back(reference.standard_error);
  }
  this->drop_zero_errors();
}

bool in_single_precision(const Seen& seen) {
  for (std::size_t i = 0; i < seen.data.size(); ++i) {
    if (!seen.data[i].images.single_precision() || mapping_of(seen.question, i).changes()) {
      return false;
    }
  }
  return true;
}

template struct ImagePair<float>;
template struct ImagePair<double>;

template <class Real>
stats::ImageStack<Real> difference(const stats::ImageStack<Real>& one,
                                   const stats::ImageStack<Real>& other,
                                   std::vector<Real>& texels) {
  stats::ImageStack<Real> differences{one.extent, {}, one.there};
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
template stats::ImageStack<float> difference(const stats::ImageStack<float>&,
                                             const stats::ImageStack<float>&, std::vector<float>&);

template <class Real>
ChannelMeans channel_means(const stats::ImageStack<Real>& stack) {
  return channel_means(stats::image_channel_sums(stack, on_all_threads), stack.extent);
}
template ChannelMeans channel_means(const stats::ImageStack<float>&);
template ChannelMeans channel_means(const stats::ImageStack<double>&);

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

double uniform_error(const ChannelMeans& first, const ChannelMeans& second, bool relative) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < first.size(); ++c) {
    const double error = std::hypot(first[c].standard_error, second[c].standard_error);
    least = std::min(least, relative ? error / std::abs(second[c].value) : error);
  }
  return least;
}

}  // namespace assay::harness
