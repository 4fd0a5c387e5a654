#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "stats/basics/for_each.h"

namespace assay::stats {

// Images as numbers. The element of column x, row y and channel c stands at (y * width + x) *
// channels + c.
struct ImageExtent {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 1;

  std::size_t row() const { return width * channels; }
  std::size_t elements() const { return row() * height; }
  friend bool operator==(const ImageExtent&, const ImageExtent&) = default;
};

struct ElementRange {
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();  // One past the end.

  std::size_t size() const { return last - first; }
};

struct RowRange {
  std::size_t first = 0;
  std::size_t last = 0;  // One past the end.

  ElementRange elements(const ImageExtent& extent) const {
    return {first * extent.row(), last * extent.row()};
  }
};

// Replicates of one image: independent, of one law, in single precision as renderers write them.
// Each has extent.elements() finite values, or only those that are `there`.
struct ImageStack {
  ImageExtent extent;
  std::vector<std::span<const float>> images;
  ElementRange there = {};

  // Pointer to that element of an image.
  const float* at(std::size_t image, std::size_t element) const {
    return images[image].data() + (element - there.first);
  }
};

// An image known exactly (standard_error empty) or with a standard error for each element.
struct ImageReference {
  ImageExtent extent;
  std::span<const double> value;
  std::span<const double> standard_error = {};
};

// A stack, and a second stack or a reference to hold it against. The stacks must outlive it.
struct ImagePair {
  ImagePair(const ImageStack& first, const ImageStack& second) : a(first), b(&second) {}
  ImagePair(const ImageStack& first, const ImageReference& second) : a(first), reference(second) {}

  const ImageStack& a;
  const ImageStack* b = nullptr;  // Null if it is held against the reference.
  ImageReference reference = {};
};

// The images of one stack less those of another, in `numbers`.
ImageStack difference(const ImageStack& one, const ImageStack& other, std::vector<float>& numbers,
                      const ForEach& for_each = one_by_one);

// The sum of products of two images' elements.
inline double dot(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  }
  return sum;
}

// Methods on images need this many replicates for a variance of their own. With fewer, Student's
// tails at the level of thousands of elements reject nothing (15 degrees: |t| > 12 at 5e-9).
inline constexpr std::size_t least_replicates = 16;

namespace check {
// These throw std::domain_error: empty or unequal extents, wrong sizes, fewer than least_replicates
// images. A stack's size must match what it says is there. reference_error is 0 without standard
// errors, and throws if negative or not finite.
void image_stack(const char* function, const ImageStack& stack);
void image_pair(const char* function, const ImagePair& pair);
double reference_error(const char* function, const ImageReference& reference, std::size_t element);
void replicates(const char* function, std::size_t count);
}  // namespace check

}  // namespace assay::stats
