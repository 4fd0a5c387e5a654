#pragma once

#include <algorithm>
#include <cstddef>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

namespace assay::harness {

/// Places of channels among those of an estimator: of some, or of an image's elements at even
/// steps.
class ChannelList {
 public:
  ChannelList() = default;
  ChannelList(std::vector<std::size_t> places)
      : places_(std::move(places)), size_(places_.size()) {}
  /// first, first + step, …
  ChannelList(std::size_t first, std::size_t step, std::size_t size)
      : first_(first), step_(step), size_(size) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool side_by_side() const { return places_.empty() && step_ == 1; }
  std::size_t operator[](std::size_t i) const {
    return places_.empty() ? first_ + i * step_ : places_[i];
  }
  bool contains(std::size_t place) const {
    if (!places_.empty()) return std::ranges::find(places_, place) != places_.end();
    return place >= first_ && (place - first_) % step_ == 0 && (place - first_) / step_ < size_;
  }
  auto all() const {
    return std::views::iota(std::size_t{0}, size_) |
           std::views::transform([this](std::size_t i) { return (*this)[i]; });
  }

 private:
  std::vector<std::size_t> places_;
  std::size_t first_ = 0;
  std::size_t step_ = 1;
  std::size_t size_ = 0;
};

/// Observed images: the numbers of each, in single precision.
using Images = std::span<const std::vector<float>>;

/// The elements of each image at these channels, in their order. Channels that stand side by side
/// are viewed, others copied.
class ImageViews {
 public:
  ImageViews() = default;
  /// The images must outlive it.
  ImageViews(Images images, const ChannelList& channels) {
    for (const std::vector<float>& image : images) {
      if (channels.side_by_side()) {
        images_.push_back(std::span(image).subspan(channels[0], channels.size()));
        continue;
      }
      std::vector<float>& copy = copies_.emplace_back();
      std::ranges::transform(channels.all(), std::back_inserter(copy),
                             [&](std::size_t channel) { return image[channel]; });
      images_.emplace_back(copy);
    }
  }
  /// Owns the images.
  explicit ImageViews(std::vector<std::vector<float>> images)
      : copies_(std::move(images)), images_(copies_.begin(), copies_.end()) {}
  ImageViews(const ImageViews&) = delete;  // views point into copies
  ImageViews& operator=(const ImageViews&) = delete;
  // Moving a vector does not move its elements.
  ImageViews(ImageViews&&) noexcept = default;
  ImageViews& operator=(ImageViews&&) noexcept = default;

  const std::vector<std::span<const float>>& images() const { return images_; }

 private:
  std::vector<std::vector<float>> copies_;
  std::vector<std::span<const float>> images_;
};

}  // namespace assay::harness
