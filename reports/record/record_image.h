#pragma once

// The part of the record that tells of images: what speaks against their equality, and maps.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/record/record_effect.h"

namespace assay::reports {

/// A sum over part of an image, or over all of it, that speaks against equality.
struct ImageFinding {
  /// "window", "alternating" (signs); of laws what differs: "the mean is larger in a".
  std::string statistic;
  std::string place;                                  ///< where, and its z, in words
  std::uint64_t x = 0, y = 0, width = 0, height = 0;  ///< the rectangle of pixels
  std::string component;
  Number z;  ///< positive where the first image is brighter
  Number log10_p;
  Number log10_p_adjusted;       ///< in the family of everything that was looked at in the image
  std::optional<Effect> effect;  ///< difference of the means over the rectangle, of the winner
  ASSAY_FIELDS(ImageFinding, statistic, place, x, y, width, height, component, z, log10_p,
               log10_p_adjusted, effect)
};

/// A claim on all elements of an image together.
struct Image {
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  std::uint64_t replicates = 0;
  std::uint64_t tested = 0;          ///< Elements that vary.
  std::uint64_t constant = 0;        ///< Elements that do not vary and equal the reference.
  std::uint64_t unseen = 0;          ///< Elements that do not vary and differ from it.
  ImageFinding winner;               ///< The least adjusted p.
  std::vector<ImageFinding> groups;  ///< The best of each group of sums.
  ASSAY_FIELDS(Image, width, height, components, replicates, tested, constant, unseen, winner,
               groups)
};

/// Numbers of an image; in JSON base64 of little-endian 32-bit floats.
struct Texels {
  std::vector<float> values;
  bool operator==(const Texels&) const = default;
};

/// One number an element: column x, row y and component c are at (y * width + x) * components + c.
/// A map of a sampler's domain has a number a cell: `cells_observed`, `cells_expected`, `cells_z`.
/// One sample has z = (observed - expected) / sqrt(expected). Two samples are expected to follow
/// both together. `cells_z_close` enlarges the heaviest cells; it is 0 where fewer than 5 draws are
/// expected.
struct Map {
  std::string name;    ///< `z`, `p_adjusted`, `mean`, `variance`, `reference`, `other_mean`, …
  std::string source;  ///< The estimator of a mean or variance.
  std::string file;    ///< The EXR beside the JSON, if written; `name` is its layer.
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  Texels texels;
  ASSAY_FIELDS(Map, name, source, file, width, height, components, texels)
};

}  // namespace assay::reports
