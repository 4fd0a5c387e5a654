#include "harness/sampling/image_views.h"

namespace assay::harness {

ImageViews::ImageViews(Images images, const ChannelList& channels) {
  for (const std::vector<float>& image : images) {
    if (channels.side_by_side()) {
      images_.push_back(std::span(image).subspan(channels[0], channels.size()));
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
