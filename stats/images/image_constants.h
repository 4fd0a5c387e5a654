#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/images/image_family.h"

namespace assay::stats {

// Elements of images that never varied. They have no standard error, and rare values may be unseen
// (stats/means/constant_sample.h). Their values differ by rounding only.

// A range holds an element's values, and a number bounds their rounding.
struct DeclaredValues {
  double low;
  double high;
  double rounding;
  double precision = 0;  // Relative rounding of the numbers as they were drawn.
  double offset = 0;     // Added after that.

  double error(double value) const;
};

// One for each element, or one that all share.
using Declarations = std::vector<DeclaredValues>;

// Declares differences of images from others near `image`, but for their range.
Declarations of_differences(Declarations one, const Declarations& other,
                            std::span<const float> image);

struct ImageConstants {
  std::vector<UnseenElement> unseen = {};  // They are tested by their ranges.
  std::size_t count = 0;                   // Elements in which nothing varied on either side.
};

// One side's images, and what is declared of them. Images with a changed element are kept.
struct SettledSide {
  ImageStack& stack;
  Declarations declared;
};
using ChangedImages = std::vector<std::vector<float>>;

// Gives elements that did not vary one value. Such an element is tested in sums with its
// neighbours. By itself it is held against its range, in `unseen`. Without a declared range unseen
// values are taken to be as large as the values around it, if all of these elements vary. Else they
// are as large as all values of the image. Constants that differ by rounding only are equal. A
// reference whose errors are all 0 afterwards has none. Differences of pairs that differ from the
// reference without any spread are left to image_pyramid.
ImageConstants settle_constants(SettledSide side, std::vector<double>& reference,
                                std::vector<double>& error, bool of_pairs, ChangedImages& changed);

// The same of two images, whose different constants are left to image_pyramid. If one of them alone
// varied, its standard error tests the other's constant, provided that the other declares a range.
// Without a range Welch's test takes the values seen.
ImageConstants settle_constants(SettledSide first, SettledSide second, ChangedImages& changed);

}  // namespace assay::stats
