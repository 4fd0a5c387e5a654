#pragma once

// Evidence about images. theta is the size of their difference over all elements,
//   theta = ||E a - E b|| / ||E b||, or its root mean square where margins are absolute.
// "theta = 0" is tested by the family of cells of every size, alternating sums and the sum of
// squares (stats/image_pyramid.h); other values by the unbiased squared bias
// (stats/image_equivalence.h).

#include "harness/image/image_constants.h"
#include "harness/image/image_pair.h"
#include "harness/theta/evidence.h"
#include "harness/theta/family.h"
#include "stats/images/image_family.h"

namespace assay::harness {

struct PictureLook;

/// How the family is tested; frozen by the plan, but for the share of the level.
struct ImageTest {
  ErrorShare share = {};                 ///< of this look
  std::uint32_t smallest_cell = 1;       ///< that the pilot lets keep its level
  std::span<const double> weights = {};  ///< of the elements, from the pilot
  bool symmetric = true;              ///< no skewness that the elements' differences have in common
  bool independent = true;            ///< whether an image's elements are; else signs are flipped
  StreamKey flips = {};               ///< of the signs, where there are too many to enumerate
  const PictureLook* look = nullptr;  ///< at pictures, taken when they were read
};

struct ImageOutcome {
  stats::ImageFamily family = {};
  std::vector<UnseenElement> unseen = {};
  std::vector<double> z = {};  ///< of every element: Welch's, or of the bound on what was unseen
  std::size_t replicates = 0;  ///< the most of a side
  std::uint32_t smallest_cell = 1;
  bool symmetric = true;       ///< else the sum of squares took no part, without a pilot's weights
  bool by_sign_flips = false;  ///< whether the sum of squares was judged so
  double wanted = 0;           ///< replicates that would decide, as far as can be told; 0: none
  double uniform_error = 0;    ///< standard error of theta, were it the same everywhere
  /// By which the tails of some cells that take part depart from nominal at least, by the skewness
  /// that cells of a size have in common in the test's own images: what a pilot has not met (rare
  /// lights). Of images whose pixels depend on each other by the mean of their own factors, less
  /// what one normal cell scatters. 1 of streamed pictures.
  double level_factor = 1;
};

struct ImageEvidence {
  Evidence evidence;
  ImageOutcome outcome;
};

/// Throws std::domain_error for fewer than 16 replicates, and where nothing varies.
ImageEvidence evidence_of_images(const Question& question, const ImageTest& test,
                                 std::span<const ChannelData> data);

/// Where in an image a finding lies: "columns 8-15, rows 16-23 of red (8 x 8 pixels), z = +6.1".
std::string place_text(const stats::ImageFinding& finding, const ImageShape& shape);

}  // namespace assay::harness
