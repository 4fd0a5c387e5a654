#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"

namespace assay::stats {

// An image of one of two stacks: 0 the first, 1 the second.
struct WhichImage {
  std::size_t side = 0;
  std::size_t index = 0;
  friend bool operator==(const WhichImage&, const WhichImage&) = default;
};

// Two images that agree in a tile bit for bit, although its elements vary.
struct RepeatedTile {
  Rectangle tile = {};
  WhichImage one = {};
  WhichImage other = {};
  std::size_t tiles = 0;  // That are repeated anywhere.
  friend bool operator==(const RepeatedTile&, const RepeatedTile&) = default;
};

// Images that are more alike than others: each with the next of its side, or with that of the same
// index on the other side.
struct AlikeImages {
  bool across = false;
  std::size_t side = 0;    // If not across.
  double correlation = 0;  // Mean over the pairs, of ranks among the side's images.
  friend bool operator==(const AlikeImages&, const AlikeImages&) = default;
};

struct ImageDependence {
  std::optional<RepeatedTile> repeated = {};
  std::optional<AlikeImages> alike = {};
  friend bool operator==(const ImageDependence&, const ImageDependence&) = default;
};

// Do images depend on each other? Null hypothesis: all images are independent, those of a side of
// one law.
//
// Tiles of 8 x 8 pixels are compared bit for bit over all images. A value has a frequency among the
// images at its pixel. Let q be the product of the frequencies of a tile's values. Two independent
// images agree in such values with probability q at most. A tile is repeated if q times the number
// of comparisons is below 1e-6. The value that weighs most in q is left out: pixels may be black
// together. Other pixels of a tile may depend on each other, as a filter spreads samples over many.
// No frequency is taken below 1/8 for that.
//
// At most 16384 elements are ranked among the side's images. The mean correlation of neighbours,
// and of equal indices across, is held against that of other pairs with indices near each other. It
// is a dependence from 8 standard errors and .05 on.
class RowDependence {
 public:
  // Takes rows that follow on those before, in multiples of 8 but for the last.
  void take(const ImagePair& pair, RowRange rows, const ForEach& for_each = one_by_one);
  // To be called after the last rows.
  ImageDependence found() const;

 private:
  std::optional<RepeatedTile> repeated_;
  std::vector<std::vector<std::vector<float>>> sampled_;  // [side][element][image]
};

// The same of whole images.
ImageDependence image_dependence(const ImagePair& pair, const ForEach& for_each = one_by_one);

}  // namespace assay::stats
