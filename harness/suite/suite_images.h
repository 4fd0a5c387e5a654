#pragma once

// `assay images`: compares two sets of rendered pictures without a suite file.

#include <optional>
#include <string>

#include "harness/suite/suite.h"

namespace assay::harness {

/// The question about two sets of pictures. Are their means equal? Are the means of differences 0,
/// where equal names have equal seeds? Is their whole law the same?
enum class ImageQuestion { means, paired, law };

struct ImagesArguments {
  std::string candidate;            ///< A pattern of pictures, one observation each.
  std::string reference;            ///< A pattern, or one file.
  std::string channels = "usual";   ///< Patterns separated by commas.
  bool independent_pixels = false;  ///< Pixels of one picture are independent.
  ImageQuestion question = ImageQuestion::means;
  bool ignores_nonfinite = false;           ///< Leaves out pixels that are not finite somewhere.
  std::optional<std::string> mask = {};     ///< A picture; where it is 0 pixels are left out.
  std::optional<std::string> samples = {};  ///< For a reference that carries its variance.
  std::optional<std::string> detect = {};
  std::optional<std::string> allow = {};
  std::optional<std::string> within = {};
};

/// The suite of the claim `mean(candidate) == mean(reference)`, or `within` a margin of it. Several
/// layers have a claim each, on `candidate_LAYER` and `reference_LAYER`. The usual channels include
/// alpha unless it is 1, or missing, throughout the first picture of each side. Files of unequal
/// windows on one canvas are compared where both have pixels. Both sides are rounded as the coarser
/// one is. A single reference file is a mean whose error its channels tell (pbrt's `Variance.*`,
/// Mitsuba's `m2_*`), else exact. InputError if a pattern matches no file, there are too few
/// pictures for a pixel's variance, or options contradict each other.
Suite suite_of_images(const ImagesArguments&);

}  // namespace assay::harness
