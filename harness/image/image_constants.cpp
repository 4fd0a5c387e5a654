#include "harness/image/image_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "stats/basics/moments.h"
#include "stats/means/constant_sample.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// A channel's declaration of its values.
struct Declared {
  double low;
  double high;
  double rounding;
  double precision = 0;  ///< relative rounding of an image's numbers when they are drawn
  double offset = 0;     ///< added after that
  /// The largest error of a value.
  double error(double value) const {
    return rounding + precision * (std::abs(value) + std::abs(value - offset));
  }
};

struct Span {
  double low;
  double high;
  bool constant(const Declared& channel) const { return high - low <= 2 * channel.error(low); }
};

/// Declarations of each element, or one that all share.
using Declarations = std::vector<Declared>;

const Declared& declared_at(const Declarations& all, std::size_t element) {
  return all[all.size() == 1 ? 0 : element];
}

/// Pictures of files share one.
Declarations declared_by(const Subject& subject) {
  if (subject.setup->pictures()) return {{Channel().low, Channel().high, Channel().rounding}};
  const double precision = relative_rounding(*subject.setup);
  Declarations all;
  all.reserve(subject.channels.size());
  for (const Channel& channel : subject.declared()) {
    all.push_back({channel.low, channel.high, channel.rounding, precision});
  }
  return all;
}

/// The declarations of differences from images near `image`, but for their range.
Declarations subtracted(Declarations one, const Declarations& other, std::span<const float> image) {
  one.resize(std::max(one.size(), other.size()), one[0]);
  for (std::size_t i = 0; i < one.size(); ++i) {
    one[i].rounding = one[i].error(image[i]) + declared_at(other, i).error(image[i]);
  }
  return one;
}

/// The value of a constant, and the range of the law whose other values it can have missed.
struct Missing : stats::ConstantSample {
  /// Tests it against a mean that is known or estimated.
  double log_p(const Constant& mean) const {
    return stats::log_p_constant({value, std::min(low, value), std::max(high, value), count},
                                 {mean.value, mean.standard_error});
  }
  double sign(const Constant& mean) const { return value < mean.value ? -1 : 1; }
  bool bounded(const Constant& mean) const {
    return std::isfinite(mean.value < value ? low : high);
  }
};

/// The second side's declarations of factor x + offset.
Declarations mapped_by(const Question& question) {
  Declarations all = declared_by(question.subjects[1]);
  for (Declared& each : all) {
    const double low = question.factor * each.low + question.offset;
    const double high = question.factor * each.high + question.offset;
    each.low = std::min(low, high);
    each.high = std::max(low, high);
    each.rounding *= std::abs(question.factor);
    each.offset = question.offset;
  }
  return all;
}

/// A side's images. Its elements are looked through in order.
class ScannedSide {
 public:
  ScannedSide(stats::ImageStack& stack, Declarations declarations)
      : stack_(stack), declarations_(std::move(declarations)) {}

  const Declared& declared(std::size_t element) const {
    return declared_at(declarations_, element);
  }
  /// The element of the first image.
  double value(std::size_t element) const { return stack_.images[0][element]; }
  const Span& span(std::size_t element) const { return spans_[element % at_a_time]; }

  /// Call it for every element from 0 on.
  bool is_constant(std::size_t element) {
    if (element % at_a_time == 0) any_constant_ = find_spans(element);
    return any_constant_ && span(element).constant(declared(element));
  }
  Missing missing(std::size_t element) const {
    return {{value(element), declared(element).low, declared(element).high, stack_.images.size()}};
  }
  Constant mean(std::size_t element) const {
    stats::Moments moments;
    for (const std::span<const float> image : stack_.images) moments.add(image[element]);
    return {moments.mean, moments.standard_error()};
  }

  /// Gives the element this value in every image.
  void settle(std::size_t element, double number) { settled_.push_back({element, number}); }
  /// Call it after the last element. Changed images are kept in `copies`.
  void replace(std::vector<std::vector<float>>& copies) {
    if (settled_.empty()) return;
    for (std::span<const float>& image : stack_.images) {
      std::vector<float>& copy = copies.emplace_back(image.begin(), image.end());
      for (const auto& [element, number] : settled_) copy[element] = static_cast<float>(number);
      image = copy;
    }
  }

 private:
  static constexpr std::size_t at_a_time = 256;

  /// Finds ranges of the elements from `first` on. An element's scan ends as soon as it is seen to
  /// vary, nearly always at the second image. Returns whether any may be constant.
  bool find_spans(std::size_t first) {
    const std::size_t size = std::min(at_a_time, stack_.extent.elements() - first);
    for (std::size_t i = 0; i < size; ++i) spans_[i] = {value(first + i), value(first + i)};
    bool constants = true;
    for (std::size_t r = 1; r < stack_.images.size() && constants; ++r) {
      const float* const image = stack_.images[r].data() + first;
      constants = false;
      for (std::size_t i = 0; i < size; ++i) {
        const double number = image[i];
        spans_[i].low = std::min(spans_[i].low, number);
        spans_[i].high = std::max(spans_[i].high, number);
        constants |= spans_[i].constant(declared(first + i));
      }
    }
    return constants;
  }

  stats::ImageStack& stack_;
  Declarations declarations_;
  std::array<Span, at_a_time> spans_{};  // of the elements around the last one
  bool any_constant_ = false;
  std::vector<std::pair<std::size_t, double>> settled_;
};

}  // namespace

double z_of(const UnseenElement& unseen) {
  if (unseen.log_p == std::numeric_limits<double>::lowest()) {
    return unseen.sign * stats::certain_z;
  }
  return unseen.sign * stats::normal_quantile({stats::Tail::upper, unseen.log_p - std::log(2.0)});
}

VaryingPart::VaryingPart(const Question& question, ImagePair&& pair)
    : ComparedImages(std::move(static_cast<ComparedImages&>(pair))) {
  if (second) {
    settle_two(question);
  } else {
    settle_against_reference(
        question, pair.subtracted ? pair.subtracted->images[0] : std::span<const float>());
  }
}

void VaryingPart::settle_against_reference(const Question& question, std::span<const float> other) {
  auto& [images, none, numbers, errors] = static_cast<ComparedImages&>(*this);
  Declarations declarations = declared_by(question.subjects[0]);
  if (!other.empty()) {
    declarations = subtracted(std::move(declarations), mapped_by(question), other);
  }
  ScannedSide side(images, std::move(declarations));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!side.is_constant(i)) continue;
    const double constant = side.value(i);
    const Constant expected{numbers[i], errors.empty() ? 0 : errors[i]};
    const bool differs =
        std::abs(constant - expected.value) > side.declared(i).error(expected.value);
    if (differs && question.is().of_pairs) continue;  // it fails, as of two images
    ++constants_;
    if (side.span(i).low < side.span(i).high) side.settle(i, constant);
    if (differs) {
      const Missing missing = side.missing(i);
      unseen_.push_back({i, missing.sign(expected), missing.log_p(expected)});
      continue;
    }
    numbers[i] = constant;
    if (!errors.empty()) errors[i] = 0;
  }
  if (std::ranges::all_of(errors, [](double each) { return each == 0; })) errors.clear();
  side.replace(settled_);
}

void VaryingPart::settle_two(const Question& question) {
  ScannedSide one(first, declared_by(question.subjects[0]));
  ScannedSide two(*second, mapped_by(question));
  for (std::size_t i = 0; i < first.extent.elements(); ++i) {
    const bool first_constant = one.is_constant(i);
    const bool second_constant = two.is_constant(i);
    if (!first_constant && !second_constant) continue;
    if (first_constant && second_constant) {
      ++constants_;
      const double a = one.value(i);
      const double b = two.value(i);
      const bool equal = std::abs(a - b) <= one.declared(i).error(a) + two.declared(i).error(b);
      one.settle(i, a);
      two.settle(i, equal ? a : b);
      continue;
    }
    const Missing missing = (first_constant ? one : two).missing(i);
    const Constant mean = (first_constant ? two : one).mean(i);
    if (!missing.bounded(mean)) continue;
    const double sign = first_constant ? missing.sign(mean) : -missing.sign(mean);
    unseen_.push_back({i, sign, missing.log_p(mean)});
    one.settle(i, missing.value);
    two.settle(i, missing.value);
  }
  one.replace(settled_);
  two.replace(settled_);
}

}  // namespace assay::harness
