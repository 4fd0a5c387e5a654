#pragma once

// Elements of images that never varied. There is no standard error to test them with, and what was
// never seen may still be there.

#include <cstddef>
#include <span>
#include <vector>

#include "harness/image/image_pair.h"
#include "harness/question/question.h"

namespace assay::harness {

/// An element that was the same in every replicate and differs from its reference, or from another
/// image's mean, by more than rounding: what was never seen may make up the difference
/// (stats/constant_sample.h). Without a declared range its p-value is 1.
struct UnseenElement {
  std::size_t element = 0;
  double sign = 0;  ///< of constant - reference
  double log_p = 0;
};

/// The normal z of that p, with the difference's sign.
double z_of(const UnseenElement& unseen);

/// An image pair as far as its elements varied, by more than their channels' declared rounding.
/// Against a reference an element that did not is equal to it and exact; its difference, if there
/// is one, is among `unseen`. Of two images, constants that differ by no more than rounding are
/// equal; an element that varied in one image alone is as one against a reference with that image's
/// standard error, where the other declares a range (without one Welch's test takes what was seen).
///
/// Sums over several elements must not lose those that happened not to vary: the rarely lit pixels
/// that were seen lit would be left, whose means are too high on average. An element with a weight,
/// one that varied in the pilot, stays in the sums as it is (`in_sums`), whatever it did here; one
/// without is in no sum. Where no weights are known the halves of the images decide over each
/// other.
template <class Real>
class VaryingPart {
 public:
  /// `weights` of the elements in sums, as ImageTest has them.
  VaryingPart(const Question& question, const ImagePair<Real>& pair,
              std::span<const double> weights);
  VaryingPart(const VaryingPart&) = delete;  // spans point inside
  VaryingPart& operator=(const VaryingPart&) = delete;

  const std::vector<UnseenElement>& unseen() const { return unseen_; }
  /// Whether any element varied.
  bool any() const { return constants_ < first_.extent.elements(); }
  const stats::ImageStack<Real>& first() const { return first_; }

  /// What `use` makes of the first stack and what it is held against.
  template <class Use>
  auto with(const Use& use) const {
    if (of_two_) return use(first_, second_);
    return use(first_, stats::ImageReference{first_.extent, value_, error_});
  }
  /// The same for sums over elements, of which those in left_to_sums() take no part alone.
  template <class Use>
  auto in_sums(const Use& use) const {
    if (of_two_) return use(first_, second_);
    return use(first_, stats::ImageReference{first_.extent, value_in_sums_, error_in_sums_});
  }
  /// In rising order.
  const std::vector<std::size_t>& left_to_sums() const { return left_to_sums_; }

 private:
  bool stays_in_sums(std::size_t element) const {
    return !weights_.empty() && weights_[element] > 0;
  }
  void settle_against_reference(const Question& question, const ImagePair<Real>& pair);
  void settle_two(const Question& question);

  bool of_two_ = false;
  stats::ImageStack<Real> first_;
  stats::ImageStack<Real> second_;
  std::vector<std::vector<Real>> settled_;  // images of which an element was rounded
  std::vector<double> value_;
  std::vector<double> error_;
  std::vector<double> value_in_sums_;
  std::vector<double> error_in_sums_;
  std::span<const double> weights_;
  std::vector<std::size_t> left_to_sums_;
  std::vector<UnseenElement> unseen_;
  std::size_t constants_ = 0;
};

}  // namespace assay::harness
