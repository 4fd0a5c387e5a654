#include "harness/image_pair.h"

#include <algorithm>

namespace assay::harness {
namespace {

using Views = std::vector<std::span<const double>>;

/// c y + b: what E x is compared with.
ImageViews mapped(const Views& images, double factor, double offset) {
  std::vector<std::vector<double>> copies;
  for (const std::span<const double> image : images) {
    std::vector<double>& copy = copies.emplace_back(image.begin(), image.end());
    for (double& value : copy) value = factor * value + offset;
  }
  return ImageViews(std::move(copies));
}

}  // namespace

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

ImagePair::ImagePair(const Question& question, std::span<const ChannelData> data)
    : extent_(extent_of(*question.subjects[0].image)), first_{extent_, data[0].images.images()} {
  if (question.of_two()) {
    const bool as_drawn = question.factor == 1 && question.offset == 0;
    const Views& drawn = data[1].images.images();
    if (!as_drawn) scaled_ = mapped(drawn, question.factor, question.offset);
    second_ = stats::ImageStack<double>{extent_, as_drawn ? drawn : scaled_.images()};
    return;
  }
  for (const Constant& reference : question.references) {
    value_.push_back(reference.value + question.offset);
    error_.push_back(reference.standard_error);
  }
  if (std::all_of(error_.begin(), error_.end(), [](double e) { return e == 0; })) error_.clear();
}

}  // namespace assay::harness
