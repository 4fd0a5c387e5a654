#pragma once

// Sums over pictures of millions of elements, whose rows are read once.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "harness/base/large_vector.h"
#include "harness/language/claim.h"
#include "stats/basics/moments.h"
#include "stats/images/image.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_family.h"

namespace assay::harness {

/// Extremes over some elements.
struct Extremes {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;  ///< values that are not zero

  void merge(const Extremes& other);
  /// Takes values, all of them finite.
  void add(std::span<const float> values);
};

/// The moments of every element that maps show. All values are finite.
struct ElementSums {
  std::uint64_t count = 0;  ///< number of pictures
  LargeVector<double> mean = {};
  LargeVector<double> m2 = {};
  stats::Moments first = {};    ///< all moments of the first element
  stats::Moments average = {};  ///< moments of the pictures' averages
  Extremes extremes = {};

  /// The moments of an element, or of the average, which follows the elements.
  stats::Moments moments(std::size_t channel) const;
  /// Room for the moments of the rows that follow. Takes those of the first element.
  stats::MomentArrays room_for(const stats::ImageStack& stack, stats::RowRange rows);
  /// Takes the rows that follow.
  void take(const stats::ImageStack& stack, stats::RowRange rows);
};

// Results of reading two stacks of pictures for one claim.

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
