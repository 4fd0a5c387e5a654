#pragma once

// Observations that are images.

#include <cstddef>
#include <string>
#include <vector>

namespace assay {

/// What the first elements() channels of a set-up are: an image. The channel of column x, row y and
/// component c is the one of index (y * width + x) * components + c.
struct ImageShape {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::string> components = {"value"};
  /// Whether the pixels of one observation are independent random variables. They are not where
  /// they share random numbers, where a filter reaches over several or where a chain visits them.
  bool independent = true;

  std::size_t pixels() const { return width * height; }
  std::size_t elements() const { return pixels() * components.size(); }
};

/// The channel's name of one pixel, as claims and messages call it: "x3y5", with several components
/// "x3y5.red".
std::string element_name(const ImageShape& shape, std::size_t element);

}  // namespace assay
