#include "harness/image_pair.h"

#include <algorithm>

namespace assay::harness {
namespace {

using Images = std::vector<std::vector<double>>;

stats::ImageStack<double> stack_of(const stats::ImageExtent& extent, const Images& images) {
  stats::ImageStack<double> stack{extent, {}};
  for (const std::vector<double>& image : images) stack.images.emplace_back(image);
  return stack;
}

/// c y + b: what E x is compared with.
Images mapped(Images images, double factor, double offset) {
  for (std::vector<double>& image : images) {
    for (double& value : image) value = factor * value + offset;
  }
  return images;
}

}  // namespace

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

ImagePair::ImagePair(const Question& question, std::span<const ChannelData> data)
    : extent_(extent_of(*question.subjects[0].image)), first_(stack_of(extent_, data[0].images)) {
  if (question.of_two()) {
    const bool as_drawn = question.factor == 1 && question.offset == 0;
    if (!as_drawn) scaled_ = mapped(data[1].images, question.factor, question.offset);
    second_ = stack_of(extent_, as_drawn ? data[1].images : scaled_);
    return;
  }
  for (const Constant& reference : question.references) {
    value_.push_back(reference.value + question.offset);
    error_.push_back(reference.standard_error);
  }
  if (std::all_of(error_.begin(), error_.end(), [](double e) { return e == 0; })) error_.clear();
}

}  // namespace assay::harness
