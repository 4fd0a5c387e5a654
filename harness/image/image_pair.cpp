#include "harness/image/image_pair.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "harness/base/parallel.h"
#include "stats/basics/moments.h"
#include "stats/images/image_moments.h"
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
  return mapped(subject.declared(), [&](const Channel& channel) {
    return Declared{channel.low, channel.high, channel.rounding, precision};
  });
}

/// The declarations of differences from images near `image`, but for their range.
Declarations of_differences(Declarations one, const Declarations& other,
                            std::span<const float> image) {
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
    const double low = question.mapped(each.low);
    const double high = question.mapped(each.high);
    each.low = std::min(low, high);
    each.high = std::max(low, high);
    each.rounding *= std::abs(question.factor);
    each.offset = question.offset;
  }
  return all;
}

/// A side's images.
class ScannedSide {
 public:
  ScannedSide(stats::ImageStack& stack, Declarations declarations)
      : stack_(stack), declarations_(std::move(declarations)) {}

  const Declared& declared(std::size_t element) const {
    return declared_at(declarations_, element);
  }
  double value(std::size_t element) const { return stack_.images[0][element]; }
  /// The range of the element last looked at, if it is constant.
  const Span& span() const { return span_; }

  /// Looks at the element's values until they are seen to vary, nearly always at the second.
  bool is_constant(std::size_t element) {
    span_ = {value(element), value(element)};
    return std::ranges::all_of(stack_.images, [&](std::span<const float> image) {
      const double number = image[element];
      span_ = {std::min(span_.low, number), std::max(span_.high, number)};
      return span_.constant(declared(element));
    });
  }
  Missing missing(std::size_t element) const {
    return {{value(element), declared(element).low, declared(element).high, stack_.images.size()}};
  }
  /// An end that is not declared is as far away as the values of the elements around.
  Missing missing_beside_others(std::size_t element) {
    Missing missing = this->missing(element);
    if (std::isfinite(missing.low) && std::isfinite(missing.high)) return missing;
    const double size = size_around(element);
    if (!std::isfinite(missing.low)) missing.low = missing.value - size;
    if (!std::isfinite(missing.high)) missing.high = missing.value + size;
    return missing;
  }
  Constant mean(std::size_t element) const {
    stats::Moments moments;
    add_to(moments, element);
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
  /// Beside others that never varied the whole image tells it: what makes constants is common
  /// there.
  double size_around(std::size_t element) {
    constexpr std::size_t reach = 4;
    const stats::ImageExtent& extent = stack_.extent;
    const std::size_t column = element % extent.row() / extent.channels;
    const std::size_t row = element / extent.row();
    stats::Moments around;
    for (std::size_t y = row - std::min(row, reach); y <= row + reach && y < extent.height; ++y) {
      const std::size_t first = column - std::min(column, reach);
      for (std::size_t x = first; x <= column + reach && x < extent.width; ++x) {
        const std::size_t other =
            y * extent.row() + x * extent.channels + element % extent.channels;
        if (other != element && is_constant(other)) return size_in_image(element);
        add_to(around, other);
      }
    }
    return stats::size_about(value(element), around);
  }
  double size_in_image(std::size_t element) {
    if (all_.count == 0) {
      for (std::size_t i = 0; i < stack_.extent.elements(); ++i) add_to(all_, i);
    }
    return stats::size_about(value(element), all_);
  }
  void add_to(stats::Moments& values, std::size_t element) const {
    for (const std::span<const float> image : stack_.images) values.add(image[element]);
  }

  stats::ImageStack& stack_;
  Declarations declarations_;
  Span span_{};
  stats::Moments all_;  // of all values, once they are asked for
  std::vector<std::pair<std::size_t, double>> settled_;
};

}  // namespace

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

ImagePair::ImagePair(const Seen& seen) {
  const Question& question = seen.question;
  const stats::ImageExtent extent = extent_of(*question.subjects[0].image);
  first = {extent, seen.data[0].images.images()};
  if (question.of_two()) {
    const bool maps = question.factor != 1 || question.offset != 0;
    const ImageViews& other = seen.data[1].images;
    const auto moved = [&](float texel) { return static_cast<float>(question.mapped(texel)); };
    const auto to_first = [&](const auto& image) { return mapped(image, moved); };
    if (maps) scaled_ = ImageViews(mapped(other.images(), to_first));
    second = {extent, (maps ? scaled_ : other).images()};
    if (!question.is().of_pairs) return;
    subtracted.swap(second);
    first = difference(first, *subtracted, differences_);
    value.assign(extent.elements(), 0);
    return;
  }
  value = mapped(question.references,
                 [&](const Constant& reference) { return reference.value + question.offset; });
  const bool exact = std::ranges::all_of(
      question.references, [](const Constant& each) { return each.standard_error == 0; });
  if (exact) return;
  error = mapped(question.references, &Constant::standard_error);
}

stats::ImageStack difference(const stats::ImageStack& one, const stats::ImageStack& other,
                             std::vector<float>& texels) {
  stats::ImageStack differences{one.extent, {}, one.there};
  const std::size_t count = std::min(one.images.size(), other.images.size());
  const std::size_t size = count == 0 ? 0 : one.images[0].size();
  texels.resize(count * size);
  for (std::size_t i = 0; i < count; ++i) {
    differences.images.push_back(std::span(texels).subspan(i * size, size));
  }
  on_all_threads(count, [&](std::size_t i) {
    std::ranges::transform(one.images[i], other.images[i],
                           texels.begin() + static_cast<std::ptrdiff_t>(i * size), std::minus<>());
  });
  return differences;
}

ChannelMeans channel_means(const stats::ImageStack& stack) {
  return channel_means(stats::image_channel_sums(stack, on_all_threads), stack.extent);
}

ChannelMeans channel_means(const std::vector<double>& sums, const stats::ImageExtent& extent) {
  const auto pixels = static_cast<double>(extent.width * extent.height);
  return mapped_indices(extent.channels, [&](std::size_t c) {
    stats::Moments moments;
    for (std::size_t i = c; i < sums.size(); i += extent.channels) moments.add(sums[i] / pixels);
    return Constant{moments.mean, moments.standard_error()};
  });
}

ChannelMeans channel_means(const stats::ImageReference& reference) {
  const std::size_t channels = reference.extent.channels;
  const auto pixels = static_cast<double>(reference.extent.width * reference.extent.height);
  ChannelMeans means(channels);
  for (std::size_t i = 0; i < reference.value.size(); ++i) {
    Constant& mean = means[i % channels];
    mean.value += reference.value[i] / pixels;
    if (reference.standard_error.empty()) continue;
    mean.standard_error = std::hypot(mean.standard_error, reference.standard_error[i] / pixels);
  }
  return means;
}

std::vector<double> uniform_errors(const ChannelMeans& first, const ChannelMeans& second) {
  return mapped_indices(first.size(), [&](std::size_t c) {
    return std::hypot(first[c].standard_error, second[c].standard_error);
  });
}

double least_error(std::span<const double> errors, const ChannelMeans& means, bool relative) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (!(errors[c] > 0)) continue;
    least = std::min(least, relative ? errors[c] / std::abs(means[c].value) : errors[c]);
  }
  return least;
}

double z_of(const UnseenElement& unseen) {
  if (unseen.log_p == std::numeric_limits<double>::lowest()) {
    return unseen.sign * stats::certain_z;
  }
  return unseen.sign * stats::normal_quantile({stats::Tail::upper, unseen.log_p - std::log(2.0)});
}

ImageConstants ImagePair::settle(const Question& question) {
  return second ? settle_two(question) : settle_against_reference(question);
}

ImageConstants ImagePair::settle_against_reference(const Question& question) {
  ImageConstants constants;
  Declarations declarations = declared_by(question.subjects[0]);
  if (subtracted) {
    declarations =
        of_differences(std::move(declarations), mapped_by(question), subtracted->images[0]);
  }
  ScannedSide side(first, std::move(declarations));
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!side.is_constant(i)) continue;
    const double constant = side.value(i);
    const Constant expected{value[i], error.empty() ? 0 : error[i]};
    const bool differs =
        std::abs(constant - expected.value) > side.declared(i).error(expected.value);
    if (differs && question.is().of_pairs) continue;  // it fails, as of two images
    ++constants.count;
    if (side.span().low < side.span().high) side.settle(i, constant);
    if (differs) {
      const Missing missing = side.missing_beside_others(i);
      constants.unseen.push_back({i, missing.sign(expected), missing.log_p(expected)});
      continue;
    }
    value[i] = constant;
    if (!error.empty()) error[i] = 0;
  }
  if (std::ranges::all_of(error, [](double each) { return each == 0; })) error.clear();
  side.replace(settled_);
  return constants;
}

ImageConstants ImagePair::settle_two(const Question& question) {
  ImageConstants constants;
  ScannedSide one(first, declared_by(question.subjects[0]));
  ScannedSide two(*second, mapped_by(question));
  for (std::size_t i = 0; i < first.extent.elements(); ++i) {
    const bool first_constant = one.is_constant(i);
    const bool second_constant = two.is_constant(i);
    if (!first_constant && !second_constant) continue;
    if (first_constant && second_constant) {
      ++constants.count;
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
    constants.unseen.push_back({i, sign, missing.log_p(mean)});
    one.settle(i, missing.value);
    two.settle(i, missing.value);
  }
  one.replace(settled_);
  two.replace(settled_);
  return constants;
}

}  // namespace assay::harness
