#pragma once

// A method as a plan has it: what it is called, what it needs kept, what it takes from the pilot.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"
#include "stats/cells/sampled_cells.h"
#include "stats/variances/f_ratio.h"

namespace assay::harness {

/// A run of consecutive observations with the time that drawing it took.
struct Replicate {
  std::uint64_t count = 0;
  stats::Moments moments = {};
  double seconds = 0;
};

/// One subject's data of one channel.
struct ChannelData {
  std::uint64_t primaries = 1;
  stats::Moments moments = {};
  std::span<const double> values = {};                   ///< where the method needs them
  std::vector<std::span<const double>> all_values = {};  ///< of every channel, for Keeps::points
  std::span<const std::uint64_t> cells = {};
  std::span<const stats::JointMoments> with_cost = {};  ///< by CountedCost
  stats::Moments group_variances = {};
  ImageViews images = {};  ///< observations, the subject's elements of each
  std::vector<Replicate> replicates = {};
};

/// What a method needs kept of its observations; points: the values of all channels together.
enum class Keeps { moments, values, points, cells, costs, group_variances, blocks, images };

/// Into how many replicates the observations of a method that keeps blocks are cut: enough for the
/// tails of Student's t to be near the normal's.
inline constexpr std::uint64_t replicate_count = 32;

/// A value that comes again and again, and what part of the pilot's values it is.
struct Atom {
  double value;
  double share;
};

/// By what the variance of the mean of a recorded channel's rows is multiplied.
struct RowAllowance {
  std::size_t subject;
  std::size_t channel;
  double factor;
};

/// What a method takes from the pilot, before the test's own data are seen.
struct Frozen {
  std::vector<std::optional<Atom>> atoms = {};                 ///< of each channel: two-part-ks
  std::shared_ptr<const stats::SampledCells> cells = nullptr;  ///< chi-square-two-sample
  std::vector<double> weights = {};                            ///< of an image's elements
  /// Of each channel, one or two subjects': what chi-square and F allow for, 0 where there is none.
  std::vector<stats::ExcessKurtoses> excess_kurtoses = {};
  std::vector<RowAllowance> row_allowances = {};  ///< of means

  stats::ExcessKurtoses excess_kurtosis(std::size_t channel) const {
    return excess_kurtoses.empty() ? stats::ExcessKurtoses{} : excess_kurtoses[channel];
  }
  /// Of each subject over the channels, to plan with.
  stats::ExcessKurtoses largest_excess_kurtosis() const;
};

struct Method {
  std::string name;  ///< as in suites and records
  Keeps keeps;
  Frozen frozen = {};
};

}  // namespace assay::harness
