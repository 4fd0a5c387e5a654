#pragma once

// Images as the elements of whole observations.

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace assay::harness {

/// Whole observations: as they were drawn, or pictures of files in the precision that these have.
using Observations =
    std::variant<std::span<const std::vector<double>>, std::span<const std::span<const float>>>;

/// Of each observation the elements at these channels, in their order and precision: views where
/// they stand side by side, as those of a whole image do, else copies.
class ImageViews {
 public:
  template <class Real>
  using Images = std::vector<std::span<const Real>>;

  ImageViews() = default;
  /// The observations outlive it.
  ImageViews(const Observations& observations, std::span<const std::size_t> channels);
  /// Of images of its own.
  explicit ImageViews(std::vector<std::vector<double>> images);
  ImageViews(const ImageViews&) = delete;  // views point into copies
  ImageViews& operator=(const ImageViews&) = delete;
  // Moving a vector leaves its elements where they are.
  ImageViews(ImageViews&&) noexcept = default;
  ImageViews& operator=(ImageViews&&) noexcept = default;
  ~ImageViews() = default;

  bool single_precision() const { return std::holds_alternative<Kept<float>>(kept_); }
  template <class Real>
  const Images<Real>& images() const {
    return std::get<Kept<Real>>(kept_).images;
  }
  /// What `use` makes of the images of either precision.
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
  static Kept<Real> kept_of(std::span<const Observation> observations,
                            std::span<const std::size_t> channels);

  std::variant<Kept<double>, Kept<float>> kept_;
};

/// The same numbers in double precision.
ImageViews widened(const ImageViews::Images<float>& images);

}  // namespace assay::harness
