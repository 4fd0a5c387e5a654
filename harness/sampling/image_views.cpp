#include "harness/sampling/image_views.h"

namespace assay::harness {
namespace {

bool side_by_side(const ChannelList& channels) {
  for (std::size_t i = 1; i < channels.size(); ++i) {
    if (channels[i] != channels[0] + i) return false;
  }
  return !channels.empty();
}

}  // namespace

ImageViews::ImageViews(Images images, const ChannelList& channels) {
  const bool whole = side_by_side(channels);
  for (const std::span<const float> image : images) {
    if (whole) {
      images_.push_back(image.subspan(channels[0], channels.size()));
      continue;
    }
    std::vector<float>& copy = copies_.emplace_back();
    copy.reserve(channels.size());
    for (const std::size_t channel : channels.all()) copy.push_back(image[channel]);
    images_.emplace_back(copy);
  }
}

ImageViews::ImageViews(std::vector<std::vector<float>> images) : copies_(std::move(images)) {
  for (const std::vector<float>& image : copies_) images_.emplace_back(image);
}

}  // namespace assay::harness
