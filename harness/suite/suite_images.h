#pragma once

// `assay images`: two sets of rendered pictures held against each other without a suite file.

#include <cstdint>
#include <optional>
#include <string>

#include "harness/suite/suite.h"

namespace assay::harness {

struct ImagesArguments {
  std::string candidate;                    ///< a pattern of OpenEXR files, one observation each
  std::string reference;                    ///< the same, or one file
  std::string channels = "usual";           ///< patterns with commas between
  bool independent_pixels = false;          ///< of one picture
  std::optional<std::string> samples = {};  ///< of a reference that carries its variance
  std::optional<std::string> detect = {};
  std::optional<std::string> allow = {};
  std::optional<std::string> within = {};
};

/// The suite of the one claim `mean(candidate) == mean(reference)`, or `within` a margin of it. A
/// reference of one file is a mean with the error that its channels tell (pbrt's `Variance.*`,
/// Mitsuba's `m2_*`), else exact. InputError for a pattern that no file matches, fewer pictures
/// than a pixel's variance takes, and options that do not go together.
Suite suite_of_images(const ImagesArguments&);

}  // namespace assay::harness
