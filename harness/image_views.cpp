#include "harness/image_views.h"

namespace assay::harness {
namespace {

bool side_by_side(std::span<const std::size_t> channels) {
  for (std::size_t i = 1; i < channels.size(); ++i) {
    if (channels[i] != channels[0] + i) return false;
  }
  return !channels.empty();
}

}  // namespace

ImageViews::ImageViews(std::span<const std::vector<double>> observations,
                       std::span<const std::size_t> channels) {
  const bool whole = side_by_side(channels);
  for (const std::vector<double>& observation : observations) {
    if (whole) {
      images_.push_back(std::span(observation).subspan(channels[0], channels.size()));
      continue;
    }
    std::vector<double>& copy = copies_.emplace_back();
    copy.reserve(channels.size());
    for (const std::size_t channel : channels) copy.push_back(observation[channel]);
    images_.emplace_back(copy);
  }
}

ImageViews::ImageViews(std::vector<std::vector<double>> images) : copies_(std::move(images)) {
  for (const std::vector<double>& image : copies_) images_.emplace_back(image);
}

}  // namespace assay::harness
