#pragma once

// Treats image elements that never varied. They have no standard error, and rare values may be
// unseen.

#include <cstddef>
#include <span>
#include <vector>

#include "harness/image/image_pair.h"
#include "harness/question/question.h"

namespace assay::harness {

/// An element that was the same in every replicate and differs from its reference, or the other
/// image's mean, by more than rounding. Unseen values may make up the difference
/// (constant_sample.h). Without a declared range its p-value is 1.
struct UnseenElement {
  std::size_t element = 0;
  double sign = 0;  ///< sign of constant - reference
  double log_p = 0;
};

/// The normal z of its p-value, with the difference's sign.
double z_of(const UnseenElement& unseen);

/// The elements of an image pair that varied by more than their channels' declared rounding. Images
/// that are drawn are also rounded to single precision.
///
/// An element that did not vary is tested in sums with its neighbours. By itself it is held against
/// its range, in `unseen`. Constants that differ by rounding only are equal. If one of two images
/// alone varied, its standard error tests the other's constant, provided that the other declares a
/// range. Without a range Welch's test takes the values seen.
struct VaryingPart : ComparedImages {
  /// Moves images and numbers out of the pair. The pair owns the texels and must outlive it.
  VaryingPart(const Question& question, ImagePair&& pair);
  VaryingPart(const VaryingPart&) = delete;  // spans point inside
  VaryingPart& operator=(const VaryingPart&) = delete;

  const std::vector<UnseenElement>& unseen() const { return unseen_; }
  bool any() const { return constants_ < first.extent.elements(); }

 private:
  void settle_against_reference(const Question& question, std::span<const float> other);
  void settle_two(const Question& question);

  std::vector<std::vector<float>> settled_;  // images with a rounded element
  std::vector<UnseenElement> unseen_;
  std::size_t constants_ = 0;
};

}  // namespace assay::harness
