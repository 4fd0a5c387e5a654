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

template <class Real, class Observation>
ImageViews::Kept<Real> ImageViews::kept_of(std::span<const Observation> observations,
                                           const ChannelList& channels) {
  Kept<Real> kept;
  const bool whole = side_by_side(channels);
  for (const Observation& observation : observations) {
    if (whole) {
      kept.images.push_back(
          std::span<const Real>(observation).subspan(channels[0], channels.size()));
      continue;
    }
    std::vector<Real>& copy = kept.copies.emplace_back();
    copy.reserve(channels.size());
    for (const std::size_t channel : channels.all()) copy.push_back(observation[channel]);
    kept.images.emplace_back(copy);
  }
  return kept;
}

ImageViews::ImageViews(const Observations& observations, const ChannelList& channels) {
  if (const auto* const pictures =
          std::get_if<std::span<const std::span<const float>>>(&observations)) {
    kept_ = kept_of<float>(*pictures, channels);
  } else {
    kept_ = kept_of<double>(std::get<0>(observations), channels);
  }
}

template <class Real>
ImageViews::ImageViews(std::vector<std::vector<Real>> images) {
  Kept<Real>& kept = kept_.emplace<Kept<Real>>();
  kept.copies = std::move(images);
  for (const std::vector<Real>& image : kept.copies) kept.images.emplace_back(image);
}
template ImageViews::ImageViews(std::vector<std::vector<float>>);
template ImageViews::ImageViews(std::vector<std::vector<double>>);

ImageViews widened(const ImageViews::Images<float>& images) {
  std::vector<std::vector<double>> copies;
  for (const std::span<const float> image : images) copies.emplace_back(image.begin(), image.end());
  return ImageViews(std::move(copies));
}

}  // namespace assay::harness
