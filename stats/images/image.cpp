#include "stats/images/image.h"

#include <algorithm>
#include <functional>
#include <string>

#include "stats/basics/check.h"

namespace assay::stats {
namespace check {
namespace {

void extent_of(const char* function, const ImageExtent& extent) {
  at_least({function, "width"}, extent.width, 1);
  at_least({function, "height"}, extent.height, 1);
  at_least({function, "channels"}, extent.channels, 1);
}

void size_of(Argument argument, std::size_t size, const ImageExtent& extent) {
  if (size != extent.elements()) {
    fail(argument, size, "width x height x channels = " + std::to_string(extent.elements()));
  }
}

void same_extent(const char* function, const ImageExtent& a, const ImageExtent& b) {
  if (a == b) return;
  const auto text = [](const ImageExtent& e) {
    return std::to_string(e.width) + " x " + std::to_string(e.height) + " x " +
           std::to_string(e.channels);
  };
  refuse({function, "extent of the second image"}, " = " + text(b),
         "that of the first, " + text(a));
}

}  // namespace

void replicates(const char* function, std::size_t count) {
  if (count < least_replicates) {
    fail({function, "replicates"}, count,
         "at least " + std::to_string(least_replicates) +
             ": each element's variance comes from them alone, and with fewer degrees of freedom "
             "no difference is significant among thousands of elements");
  }
}

void image_stack(const char* function, const ImageStack& stack) {
  extent_of(function, stack.extent);
  replicates(function, stack.images.size());
  const std::size_t elements = stack.extent.elements();
  const std::size_t last = std::min(stack.there.last, elements);
  for (const auto& image : stack.images) {
    if (image.size() + stack.there.first == last) continue;
    size_of({function, "size of an image"}, image.size(), stack.extent);
    fail({function, "size of an image"}, image.size(), "the number of elements that are there");
  }
}

double reference_error(const char* function, const ImageReference& reference, std::size_t element) {
  if (reference.standard_error.empty()) return 0;
  const double error = reference.standard_error[element];
  non_negative({function, "standard error of the reference"}, error);
  return error;
}

void image_pair(const char* function, const ImagePair& pair) {
  image_stack(function, pair.a);
  if (pair.b != nullptr) {
    image_stack(function, *pair.b);
    same_extent(function, pair.a.extent, pair.b->extent);
  } else {
    const auto& [extent, value, errors] = pair.reference;
    extent_of(function, extent);
    size_of({function, "size of the reference"}, value.size(), extent);
    if (!errors.empty()) size_of({function, "size of the standard errors"}, errors.size(), extent);
    same_extent(function, pair.a.extent, extent);
  }
}

}  // namespace check

ImageStack difference(const ImageStack& one, const ImageStack& other, std::vector<float>& numbers,
                      const ForEach& for_each) {
  ImageStack differences{one.extent, {}, one.there};
  const std::size_t count = std::min(one.images.size(), other.images.size());
  const std::size_t size = count == 0 ? 0 : one.images[0].size();
  numbers.resize(count * size);
  for (std::size_t i = 0; i < count; ++i) {
    differences.images.push_back(std::span(numbers).subspan(i * size, size));
  }
  for_each(count, [&](std::size_t i) {
    std::ranges::transform(one.images[i], other.images[i],
                           numbers.begin() + static_cast<std::ptrdiff_t>(i * size), std::minus<>());
  });
  return differences;
}

}  // namespace assay::stats
