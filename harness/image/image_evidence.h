#pragma once

// Evidence about images. theta is the size of their difference over all elements:
// `||E a - E b|| / ||E b||`, or the root mean square for absolute margins.
// The family of cells of every size and alternating sums tests theta = 0 (image_pyramid.h). The
// unbiased squared bias tests every value (image_equivalence.h).

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "harness/sampling/summary.h"
#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "stats/images/image.h"
#include "stats/images/image_constants.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_family.h"

namespace assay::harness {

stats::ImageExtent extent_of(const ImageShape& shape);

/// Replicates of an image, and their comparison: replicates of another image, scaled, or a number
/// for each element. Of a paired claim the replicates are differences, which are held against 0.
struct ImagePair {
  explicit ImagePair(const Seen& seen);
  ImagePair(const ImagePair&) = delete;  // spans point inside
  ImagePair& operator=(const ImagePair&) = delete;

  /// The fewest replicates of a side, and the most.
  auto replicates() const {
    return std::minmax({first.images.size(), (second ? *second : first).images.size()});
  }
  stats::ImageReference reference() const { return {first.extent, value, error}; }
  stats::ImagePair pair() const {
    return second ? stats::ImagePair(first, *second) : stats::ImagePair(first, reference());
  }
  /// Gives elements that did not vary one value. Their values differ by rounding only: as their
  /// channel declares, and of drawn images also to single precision.
  stats::ImageConstants settle(const Question& question);

  stats::ImageStack first = {};
  std::optional<stats::ImageStack> second = {};
  std::vector<double> value = {};
  std::vector<double> error = {};  ///< Empty if no number has one.
  /// The replicates that were subtracted in pairs.
  std::optional<stats::ImageStack> subtracted = {};

 private:
  ImageViews scaled_;  // the second side, if it is
  std::vector<float> differences_;
  stats::ChangedImages settled_;
};

struct ImageTest {
  ErrorShare share = {};              ///< Share of this look.
  const PictureLook* look = nullptr;  ///< Look at pictures, taken while reading.
  StreamKey labels = {};              ///< Of a permutation test.
  /// Throws std::domain_error if images depend on each other.
  std::function<void(const stats::ImageDependence&)> require_independent = {};
};

struct ImageOutcome {
  stats::ImageFamily family = {};
  std::vector<double> z = {};  ///< For every element: Welch's, or of the bound on the unseen.
  std::size_t replicates = 0;  ///< The larger side's.
  std::string seen = {};       ///< What differs at the place and on which side, of laws.
  double wanted = 0;           ///< Replicates that would decide, roughly; 0: none.
  double uniform_error = 0;    ///< Standard error of a theta that is the same everywhere.
  double cell_error = 0;       ///< The same in a typical cell; a part of the whole image's mean.
  std::optional<double> detectable_in_cell = {};  ///< As ChannelOutcome::detectable.
};

struct ChannelEvidence {
  Evidence evidence;
  std::optional<ImageOutcome> image = {};
};

/// Throws std::domain_error for fewer than 16 replicates, and if nothing varies that is drawn.
ChannelEvidence evidence_of_images(const Seen& seen, const ImageTest& test);

/// Evidence that two images have different laws (stats/images/image_law.h). Theta is 0 or not.
ChannelEvidence evidence_of_image_laws(const Seen& seen, const ImageTest& test);

/// The squared bias's share of alpha beside the family. It is 0 against one picture.
double share_of_distance(const Question& question);

std::vector<std::size_t> elements_of(const stats::ImageFinding& finding, const ImageShape& shape);

struct PlaceText {
  /// In the whole picture: "x 8-15, y 16-23 of red". If fewer than half of its pixels have a
  /// weight, it is "what varies in x 8-15, …".
  std::string place = "";
  std::string size = "";  ///< Follows the place: " (8 x 8 pixels), z = +6.1".
};
PlaceText place_text(const stats::ImageFinding& finding, const ImageShape& shape,
                     std::span<const float> weights);

}  // namespace assay::harness
