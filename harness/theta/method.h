#pragma once

// A method as a plan has it: what it is called, what it needs kept, what it takes from the pilot.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"
#include "harness/theta/evidence.h"
#include "stats/cells/sampled_cells.h"
#include "stats/means/power_exact.h"
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

struct Method;

/// What a method's evidence needs of the pilots, frozen before its own data are drawn.
enum class FromPilot { nothing, atoms, cells, weights };

/// What else of a method others have to know.
struct MethodTraits {
  bool exact = false;     ///< its level holds at every sample size; a reference has to be exact
  bool in_range = false;  ///< rests on the range that a channel declares
  bool of_observations = false;     ///< the moments of an earlier run are too little
  bool of_batches = false;          ///< means of consecutive observations stand for them
  bool corrects_skewness = false;   ///< of the mean, from the data
  bool of_normal_values = false;    ///< takes the values for normal, with an allowance for kurtosis
  bool of_distinct_values = false;  ///< coarsely rounded values break its level
  bool allows_distance = true;      ///< tests a claim up to `allow`
  bool excludes_larger = true;      ///< refutes "theta is larger"; else no sample size does
  bool scores = false;              ///< the estimate tells nothing of its standard error
  bool power_is_known = true;       ///< by a formula
  FromPilot from_pilot = FromPilot::nothing;
  std::optional<stats::ExactMethod> plans = {};  ///< of exact methods of a mean
};

/// A row of the method table (methods.h). Several rows may share a name: one of each family of
/// claims.
struct MethodRow {
  std::string name;     ///< as in suites and records
  std::string summary;  ///< what it tests and where it holds, for `assay list methods`
  bool (*answers)(const Question&);
  Keeps keeps;
  Evidence (*evidence)(const Method&, const Question&, std::size_t channel,
                       std::span<const ChannelData>);
  MethodTraits is = {};
};

/// A row with what a test has frozen for it.
struct Method : MethodRow {
  Frozen frozen = {};
};

/// The evidence on theta of one channel. `data` is one or two subjects', of a slope each point's.
inline Evidence evidence_of(const Method& method, const Question& question, std::size_t channel,
                            std::span<const ChannelData> data) {
  return method.evidence(method, question, channel, data);
}

}  // namespace assay::harness
