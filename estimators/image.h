#pragma once

// Observations that are images.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace assay {

/// The shape of an image, the first elements() channels of a set-up. The channel of column x, row y
/// and component c has the index (y * width + x) * components + c.
struct ImageShape {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::string> components = {"value"};
  /// True if the pixels of one observation are independent. They are not if they share random
  /// numbers, if a filter reaches over several, or if a chain visits them.
  bool independent = true;
  /// Corner in the whole picture, of which a crop shows a part.
  std::int64_t left = 0;
  std::int64_t top = 0;

  std::size_t pixels() const { return width * height; }
  std::size_t elements() const { return pixels() * components.size(); }
};

/// The channel's name of one pixel, as claims and messages call it: "x3y5", with several components
/// "x3y5.red". Columns and rows are those of the whole picture.
std::string element_name(const ImageShape& shape, std::size_t element);

}  // namespace assay
