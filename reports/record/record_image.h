#pragma once

// The part of the record that tells of images: what speaks against their equality, and maps.

#include <cstdint>
#include <string>
#include <vector>

#include "reports/record/optional_number.h"

namespace assay::reports {

/// A sum over part of an image, or over all of it, that speaks against equality.
struct ImageFinding {
  std::string statistic;  ///< "window", "alternating" (signs), "energy" (sum of squares)
  std::string place;      ///< where, and its z, in words
  std::uint64_t x = 0, y = 0, width = 0, height = 0;  ///< the rectangle of pixels
  std::string component;
  Number z;  ///< positive where the first image is brighter; of the energy: one-sided
  Number log10_p;
  Number log10_p_adjusted;  ///< in the family of everything that was looked at in the image
  bool operator==(const ImageFinding&) const = default;
};

/// A claim on all elements of an image together.
struct Image {
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  std::uint64_t replicates = 0;
  std::uint64_t tested = 0;         ///< elements that vary
  std::uint64_t constant = 0;       ///< elements that do not, and are as they should be
  std::uint64_t unseen = 0;         ///< elements that do not, and differ from an exact reference
  std::uint64_t smallest_cell = 1;  ///< side of the smallest cells in the family; 1: single pixels
  bool symmetric = true;    ///< else skewed elements' sum of squares took no part without a pilot
  bool sign_flips = false;  ///< whether the sum of squares was judged by flips of signs
  ImageFinding winner;      ///< the least adjusted p
  std::vector<ImageFinding> groups;  ///< the best of each group of sums
  bool operator==(const Image&) const = default;
};

/// Numbers of an image; in JSON base64 of little-endian 32-bit floats.
struct Texels {
  std::vector<float> values;
  bool operator==(const Texels&) const = default;
};

/// One number for each element of an image, that of column x, row y and component c at index
/// (y * width + x) * components + c.
struct Map {
  std::string name;    ///< z, p_adjusted, mean, variance, reference, other_mean, other_variance
  std::string source;  ///< of a mean or variance: the estimator
  std::string file;    ///< an EXR beside the JSON record, where one was written; layer = name
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  Texels texels;
  bool operator==(const Map&) const = default;
};

}  // namespace assay::reports
