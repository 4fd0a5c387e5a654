#pragma once

// Results of reading two stacks of pictures for one claim.

#include <cstdint>
#include <vector>

#include "harness/language/claim.h"
#include "stats/basics/moments.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_family.h"

namespace assay::harness {

/// The mean of each image channel over the pixels, with its standard error.
using ChannelMeans = std::vector<Constant>;

struct PictureLook {
  std::uint64_t pictures = 0;          ///< of each side
  stats::ImageDistance distance = {};  ///< In the images' own units.
  stats::ImageFamily family = {};      ///< With cells of every size.
  stats::ImageDependence dependence = {};
  std::vector<double> z = {};  ///< For every element.
  /// One for each side; of a paired claim those of the differences, and the second's without error.
  std::vector<ChannelMeans> means = {};
};

}  // namespace assay::harness
