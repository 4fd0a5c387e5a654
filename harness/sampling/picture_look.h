#pragma once

// Results of reading two stacks of pictures for one claim.

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/language/claim.h"
#include "stats/basics/moments.h"
#include "stats/images/image_cell_skewness.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_family.h"
#include "stats/images/image_sign_flip.h"

namespace assay::harness {

/// The mean of each image channel over the pixels, with its standard error.
using ChannelMeans = std::vector<Constant>;

struct PictureLook {
  std::uint64_t pictures = 0;                ///< of each side
  std::uint64_t piloted = 0;                 ///< The first of them chose what the test leaves out.
  std::vector<stats::CellTails> tails = {};  ///< of the piloted pictures
  stats::ImageDistance distance = {};        ///< In the images' own units.
  stats::ImageFamily family = {};            ///< With cells of every size.
  std::vector<double> z = {};                ///< Welch's, for every element.
  std::optional<stats::FlipMatrix> flips = {};  ///< If signs of whole images are to be flipped.
  std::vector<ChannelMeans> means = {};         ///< One for each side.
  double skewness = 0;  ///< Mean over the elements of the skewness of one picture's difference.
};

}  // namespace assay::harness
