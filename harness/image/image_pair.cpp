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
ImagePair<Real>::ImagePair(const Question& question, std::span<const ChannelData> data)
    : extent_(extent_of(*question.subjects[0].image)),
      first_{extent_, images_of<Real>(data[0].images, mapping_of(question, 0), made_[0])} {
  if (question.of_two()) {
    second_ = stats::ImageStack<Real>{
        extent_, images_of<Real>(data[1].images, mapping_of(question, 1), made_[1])};
    if (question.is().of_pairs) subtract();
    return;
  }
  for (const Constant& reference : question.references) {
    value_.push_back(reference.value + question.offset);
    error_.push_back(reference.standard_error);
  }
  if (std::all_of(error_.begin(), error_.end(), [](double e) { return e == 0; })) error_.clear();
}

template <class Real>
void ImagePair<Real>::subtract() {
  subtracted_ = std::move(second_);
  second_.reset();
  std::vector<std::vector<Real>> differences;
  for (std::size_t i = 0; i < std::min(first_.images.size(), subtracted_->images.size()); ++i) {
    std::vector<Real>& difference = differences.emplace_back(extent_.elements());
    std::ranges::transform(first_.images[i], subtracted_->images[i], difference.begin(),
                           std::minus<>());
  }
  differences_ = ImageViews(std::move(differences));
  first_.images = differences_.images<Real>();
  value_.assign(extent_.elements(), 0);
}

bool in_single_precision(const Question& question, std::span<const ChannelData> data) {
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (!data[i].images.single_precision() || mapping_of(question, i).changes()) return false;
  }
  return true;
}

template class ImagePair<float>;
template class ImagePair<double>;

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
