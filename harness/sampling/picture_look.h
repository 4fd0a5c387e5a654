#pragma once

// What a claim on two stacks of pictures of files takes from them.

#include <cstdint>
#include <optional>
#include <vector>

#include "estimators/estimator.h"
#include "stats/basics/moments.h"
#include "stats/images/image_cell_skewness.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_family.h"
#include "stats/images/image_sign_flip.h"

namespace assay::harness {

/// Of each channel of an image its mean over the pixels, with its standard error.
using ChannelMeans = std::vector<Constant>;

struct PictureLook {
  std::uint64_t pictures = 0;  ///< of each side
  std::uint64_t piloted = 0;   ///< the first so many of them chose what the test leaves out
  std::vector<stats::CellTails> tails = {};     ///< of those
  stats::ImageDistance distance = {};           ///< in the images' own units
  stats::ImageFamily family = {};               ///< with cells of every size
  std::vector<double> z = {};                   ///< Welch's, of every element
  std::optional<stats::FlipMatrix> flips = {};  ///< where signs of whole images are to be flipped
  std::vector<ChannelMeans> means = {};         ///< of either side
  double skewness = 0;  ///< mean over the elements of that of one picture's difference
};

}  // namespace assay::harness
