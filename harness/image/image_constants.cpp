#include "harness/image/image_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// A number of one image that replaces an element in every image of a stack.
struct Replacement {
  std::size_t element;
  double value;
};

/// The stack with these elements replaced; changed images are kept in `copies`.
stats::ImageStack replaced(const stats::ImageStack& stack,
                           const std::vector<Replacement>& replacements,
                           std::vector<std::vector<float>>& copies) {
  if (replacements.empty()) return stack;
  stats::ImageStack out{stack.extent, {}};
  for (const std::span<const float> image : stack.images) {
    std::vector<float>& copy = copies.emplace_back(image.begin(), image.end());
    for (const Replacement& each : replacements)
      copy[each.element] = static_cast<float>(each.value);
    out.images.emplace_back(copy);
  }
  return out;
}

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

constexpr std::size_t at_a_time = 256;
using Spans = std::array<Span, at_a_time>;

/// Ranges of the elements from `first` on. An element's scan ends as soon as it is seen to vary,
/// nearly always at the second image. Returns whether any may be constant.
bool find_spans(const stats::ImageStack& stack, const Declarations& channels, std::size_t first,
                Spans& spans) {
  const std::size_t size = std::min(at_a_time, stack.extent.elements() - first);
  for (std::size_t i = 0; i < size; ++i) {
    const double value = stack.images[0][first + i];
    spans[i] = {value, value};
  }
  bool constants = true;
  for (std::size_t r = 1; r < stack.images.size() && constants; ++r) {
    const float* const image = stack.images[r].data() + first;
    constants = false;
    for (std::size_t i = 0; i < size; ++i) {
      const double value = image[i];
      spans[i].low = std::min(spans[i].low, value);
      spans[i].high = std::max(spans[i].high, value);
      constants |= spans[i].constant(declared_at(channels, first + i));
    }
  }
  return constants;
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

Constant mean_of(const stats::ImageStack& stack, std::size_t element) {
  stats::Moments moments;
  for (const std::span<const float> image : stack.images) moments.add(image[element]);
  return {moments.mean, moments.standard_error()};
}

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

}  // namespace

double z_of(const UnseenElement& unseen) {
  if (unseen.log_p == std::numeric_limits<double>::lowest()) {
    return unseen.sign * stats::certain_z;
  }
  return unseen.sign * stats::normal_quantile({stats::Tail::upper, unseen.log_p - std::log(2.0)});
}

VaryingPart::VaryingPart(const Question& question, const ImagePair& pair) : ComparedImages(pair) {
  if (second) {
    settle_two(question);
  } else {
    settle_against_reference(
        question, pair.subtracted ? pair.subtracted->images[0] : std::span<const float>());
  }
}

void VaryingPart::settle_against_reference(const Question& question, std::span<const float> other) {
  auto& [images, none, numbers, errors] = static_cast<ComparedImages&>(*this);
  Declarations channels = declared_by(question.subjects[0]);
  if (!other.empty()) channels = subtracted(std::move(channels), mapped_by(question), other);
  Spans spans;
  bool constants = false;
  std::vector<Replacement> replacements;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i % at_a_time == 0) constants = find_spans(images, channels, i, spans);
    if (!constants) continue;
    const Span span = spans[i % at_a_time];
    const Declared& channel = declared_at(channels, i);
    if (!span.constant(channel)) continue;
    const double constant = images.images[0][i];
    const Constant expected{numbers[i], errors.empty() ? 0 : errors[i]};
    const bool differs = std::abs(constant - expected.value) > channel.error(expected.value);
    if (differs && question.is().of_pairs) continue;  // it fails, as of two images
    ++constants_;
    if (differs) {
      const Missing missing{constant, channel.low, channel.high, images.images.size()};
      unseen_.push_back({i, missing.sign(expected), missing.log_p(expected)});
    }
    if (span.low < span.high) replacements.push_back({i, constant});
    if (differs) continue;
    numbers[i] = constant;
    if (!errors.empty()) errors[i] = 0;
  }
  drop_zero_errors();
  images = replaced(images, replacements, settled_);
}

void VaryingPart::settle_two(const Question& question) {
  auto& stack = first;
  auto& other = *second;
  const Declarations one = declared_by(question.subjects[0]);
  const Declarations two = mapped_by(question);
  std::vector<Replacement> of_first;
  std::vector<Replacement> of_second;
  Spans first_spans;
  Spans second_spans;
  bool constants = false;
  for (std::size_t i = 0; i < stack.extent.elements(); ++i) {
    if (i % at_a_time == 0) {
      constants = find_spans(stack, one, i, first_spans);
      constants |= find_spans(other, two, i, second_spans);
    }
    if (!constants) continue;
    const bool first_constant = first_spans[i % at_a_time].constant(declared_at(one, i));
    const bool second_constant = second_spans[i % at_a_time].constant(declared_at(two, i));
    if (!first_constant && !second_constant) continue;
    const double a = stack.images[0][i];
    const double b = other.images[0][i];
    if (first_constant && second_constant) {
      ++constants_;
      const bool equal =
          std::abs(a - b) <= declared_at(one, i).error(a) + declared_at(two, i).error(b);
      of_first.push_back({i, a});
      of_second.push_back({i, equal ? a : b});
      continue;
    }
    const Declared& channel = first_constant ? declared_at(one, i) : declared_at(two, i);
    const stats::ImageStack& constant = first_constant ? stack : other;
    const Constant mean = mean_of(first_constant ? other : stack, i);
    const Missing missing{first_constant ? a : b, channel.low, channel.high,
                          constant.images.size()};
    if (!missing.bounded(mean)) continue;
    const double sign = first_constant ? missing.sign(mean) : -missing.sign(mean);
    unseen_.push_back({i, sign, missing.log_p(mean)});
    of_first.push_back({i, missing.value});
    of_second.push_back({i, missing.value});
  }
  stack = replaced(stack, of_first, settled_);
  other = replaced(other, of_second, settled_);
}

}  // namespace assay::harness
