#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "harness/sampling/channel_list.h"

namespace assay::harness {

/// Whole observations: as they were drawn, or pictures of files in their own precision.
using Observations =
    std::variant<std::span<const std::vector<double>>, std::span<const std::span<const float>>>;

/// The elements of each observation at these channels, in their order and precision. Channels that
/// stand side by side are viewed, others copied.
class ImageViews {
 public:
  template <class Real>
  using Images = std::vector<std::span<const Real>>;

  ImageViews() = default;
  /// The observations must outlive it.
  ImageViews(const Observations& observations, const ChannelList& channels);
  /// Owns the images.
  template <class Real>
  explicit ImageViews(std::vector<std::vector<Real>> images);
  ImageViews(const ImageViews&) = delete;  // views point into copies
  ImageViews& operator=(const ImageViews&) = delete;
  // Moving a vector does not move its elements.
  ImageViews(ImageViews&&) noexcept = default;
  ImageViews& operator=(ImageViews&&) noexcept = default;
  ~ImageViews() = default;

  bool single_precision() const { return std::holds_alternative<Kept<float>>(kept_); }
  template <class Real>
  const Images<Real>& images() const {
    return std::get<Kept<Real>>(kept_).images;
  }
  /// Calls `use` with the images in their precision and returns its result.
  template <class Use>
  auto with(const Use& use) const {
    return std::visit([&](const auto& kept) { return use(kept.images); }, kept_);
  }

 private:
  template <class Real>
  struct Kept {
    std::vector<std::vector<Real>> copies;
    Images<Real> images;
  };
  template <class Real, class Observation>
  static Kept<Real> kept_of(std::span<const Observation> observations, const ChannelList& channels);

  std::variant<Kept<double>, Kept<float>> kept_;
};

/// The same numbers in double precision.
ImageViews widened(const ImageViews::Images<float>& images);

}  // namespace assay::harness
