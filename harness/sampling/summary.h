#pragma once

// Summaries of many observations: moments, a histogram, counts of cells. They are mergeable and of
// fixed size.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimators/cost.h"
#include "harness/base/large_vector.h"
#include "harness/language/claim.h"
#include "harness/sampling/image_views.h"
#include "reports/record/record.h"
#include "stats/basics/joint_moments.h"
#include "stats/basics/moments.h"
#include "stats/images/image.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_family.h"
#include "stats/images/image_moments.h"

namespace assay::harness {

/// Counts in equal bins of [low, high), and below and above it.
struct Histogram : reports::Histogram {
  void add(double value) {
    if (value < low) {
      ++below;
    } else if (value >= high) {
      ++above;
    } else {
      const auto bins = static_cast<double>(counts.size());
      const auto bin = static_cast<std::size_t>((value - low) / (high - low) * bins);
      ++counts[bin < counts.size() ? bin : counts.size() - 1];
    }
  }
  void merge(const Histogram& other);
};

/// Joint moments that a channel keeps: of its values alone, or with each counted cost.
enum class Powers : std::uint64_t { none, of_values, with_costs };

struct ChannelPlan {
  double histogram_low = 0;  ///< Equal bounds: no histogram.
  double histogram_high = 0;
  std::uint64_t keep = 0;  ///< Stores the values of the first `keep` observations.
  std::size_t cells = 0;   ///< Counts values, which are cell numbers 0 … cells - 1.
  Powers powers = Powers::none;

  bool has_histogram() const { return histogram_low < histogram_high; }
  /// True if the channel's sums need more than moments.
  bool has_details() const { return has_histogram() || cells != 0 || powers != Powers::none; }
};

inline constexpr std::size_t histogram_bins = 60;

struct ChannelDetails {
  Histogram histogram = {};
  std::vector<std::uint64_t> cells = {};
  /// By CountedCost. One entry, whose cost means nothing, if those of values alone are kept.
  std::vector<stats::JointSums> joint = {};
};

using ChannelSummary = stats::FiniteMoments;

// ---- Sums over pictures of millions of elements, whose rows are read once.

/// Results of reading two stacks of pictures for one claim.
struct PictureLook {
  std::uint64_t pictures = 0;          ///< of each side
  stats::ImageDistance distance = {};  ///< In the images' own units.
  stats::ImageFamily family = {};      ///< With cells of every size.
  stats::ImageDependence dependence = {};
  std::vector<double> z = {};  ///< For every element.
  /// One for each side; of a paired claim those of the differences, and the second's without error.
  std::vector<stats::ChannelMeans> means = {};
};

/// The moments of every element that maps show. All values are finite.
struct ElementSums {
  std::uint64_t count = 0;                       ///< number of pictures
  std::shared_ptr<const PictureLook> look = {};  ///< at the pictures of both sides
  LargeVector<double> mean = {};
  LargeVector<double> m2 = {};
  stats::Moments first = {};    ///< all moments of the first element
  stats::Moments average = {};  ///< moments of the pictures' averages
  stats::Extremes extremes = {};

  /// The moments of an element, or of the average, which follows the elements.
  stats::Moments moments(std::size_t channel) const;
  /// Room for the moments of the rows that follow. Takes those of the first element.
  stats::MomentArrays room_for(const stats::ImageStack& stack, stats::RowRange rows);
  /// Takes the rows that follow.
  void take(const stats::ImageStack& stack, stats::RowRange rows);
};

// ---- Sums of observations

/// A kind of cost of an observation, the index of a channel's joint moments.
enum CountedCost : std::size_t { rays_cost, samples_cost, counted_costs };
using ObservationCost = std::array<double, counted_costs>;
inline ObservationCost counted(const Cost& cost) {
  return {static_cast<double>(cost.rays()), static_cast<double>(cost.samples)};
}

/// Observations [0, count) of a pool, or those of one block.
struct Summary {
  std::uint64_t count = 0;
  std::vector<ChannelSummary> channels = {};
  /// By channel. An image's millions of channels have none and take no room.
  std::map<std::size_t, ChannelDetails> detailed = {};
  /// In place of `channels` for pictures that are read once, row by row.
  std::shared_ptr<const ElementSums> elements = {};
  stats::Moments group_variances = {};  ///< of whole groups, if kept (stats::GroupVariance)
  Cost cost = {};
  double seconds = 0;

  /// A summary of no observations. Without a plan it keeps moments alone.
  explicit Summary(std::size_t count_of_channels = 0, std::span<const ChannelPlan> plan = {});
  /// Takes the values of an observation. The caller counts it.
  void add_observation(std::span<const double> values, std::uint64_t index,
                       const ObservationCost& counted);
  /// Appends the observations that follow. The order of blocks decides the result, not who drew
  /// them.
  void append(const Summary& next);

  stats::Moments moments(std::size_t channel) const {
    return elements ? elements->moments(channel) : channels[channel].moments;
  }
  /// Null unless the pictures were looked at while they were read.
  const PictureLook* look() const { return elements ? elements->look.get() : nullptr; }
  /// Empty details if the channel has none.
  const ChannelDetails& details(std::size_t channel) const;
};

std::vector<stats::JointMoments> joint_moments(const ChannelDetails& details);

/// Takes a value, if it is finite, and its observation's cost.
void add_details(ChannelDetails& details, double value, const ObservationCost& cost);

/// An error message if powers or moments of `name` cannot be computed with, else "". The eighth or
/// fourth power of the spread may overflow, or underflow to nothing. The observations must not all
/// be equal.
std::string beyond_doubles(const stats::JointMoments& powers, const std::string& name);
std::string beyond_doubles(const stats::Moments& moments, const std::string& name);

/// The summary of every element over the images, at least one. It has moments of the finite values.
/// It works on all threads of the caller's arena and gives the same bits for any number of threads.
std::vector<ChannelSummary> sums_of_images(Images images);

}  // namespace assay::harness
