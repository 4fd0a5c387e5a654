#pragma once

// Images as the elements of whole observations.

#include <cstddef>
#include <span>
#include <vector>

namespace assay::harness {

/// Of each observation the elements at these channels, in their order: views where they stand side
/// by side, as those of a whole image do, else copies.
class ImageViews {
 public:
  ImageViews() = default;
  /// The observations outlive it.
  ImageViews(std::span<const std::vector<double>> observations,
             std::span<const std::size_t> channels);
  /// Of images of its own.
  explicit ImageViews(std::vector<std::vector<double>> images);
  ImageViews(const ImageViews&) = delete;  // views point into copies
  ImageViews& operator=(const ImageViews&) = delete;
  ImageViews(ImageViews&&) noexcept =
      default;  // moving a vector leaves its elements where they are
  ImageViews& operator=(ImageViews&&) noexcept = default;
  ~ImageViews() = default;

  const std::vector<std::span<const double>>& images() const { return images_; }

 private:
  std::vector<std::vector<double>> copies_;
  std::vector<std::span<const double>> images_;
};

}  // namespace assay::harness
