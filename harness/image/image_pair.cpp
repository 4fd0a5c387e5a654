#include "harness/image/image_pair.h"

#include <cmath>
#include <utility>

#include "harness/base/parallel.h"

namespace assay::harness {
namespace {

using stats::Declarations;

/// Pictures of files share one.
Declarations declared_by(const Subject& subject) {
  if (subject.setup->pictures()) return {{Channel().low, Channel().high, Channel().rounding}};
  const double precision = relative_rounding(*subject.setup);
  return mapped(subject.declared(), [&](const Channel& channel) {
    return stats::DeclaredValues{channel.low, channel.high, channel.rounding, precision};
  });
}

/// The second side's declarations of factor x + offset.
Declarations mapped_by(const Question& question) {
  Declarations all = declared_by(question.subjects[1]);
  for (stats::DeclaredValues& each : all) {
    const double low = question.mapped(each.low);
    const double high = question.mapped(each.high);
    each.low = std::min(low, high);
    each.high = std::max(low, high);
    each.rounding *= std::abs(question.factor);
    each.offset = question.offset;
  }
  return all;
}

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
    first = stats::difference(first, *subtracted, differences_, on_all_threads);
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

stats::ImageConstants ImagePair::settle(const Question& question) {
  Declarations declared = declared_by(question.subjects[0]);
  if (second) {
    return stats::settle_constants({first, std::move(declared)}, {*second, mapped_by(question)},
                                   settled_);
  }
  if (subtracted) {
    declared =
        stats::of_differences(std::move(declared), mapped_by(question), subtracted->images[0]);
  }
  return stats::settle_constants({first, std::move(declared)}, value, error, question.is().of_pairs,
                                 settled_);
}

}  // namespace assay::harness
