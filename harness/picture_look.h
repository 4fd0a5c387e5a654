#pragma once

// What a claim on two stacks of pictures of files takes from them.

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/image_uniform.h"
#include "stats/image_cell_skewness.h"
#include "stats/image_equivalence.h"
#include "stats/image_family.h"
#include "stats/image_sign_flip.h"
#include "stats/moments.h"

namespace assay::harness {

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
