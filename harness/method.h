#pragma once

// The methods by name: which there are for a question, what null hypothesis each tests, and the
// evidence it draws from data.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/evidence.h"
#include "harness/image_views.h"
#include "harness/question.h"
#include "harness/summary.h"
#include "stats/f_ratio.h"
#include "stats/sampled_cells.h"

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

/// The methods that answer a question, the default first; `test:` may force any of them.
std::vector<Method> methods_for(const Question& question);

/// The method of that name. InputError at the test's place when it does not answer the question.
Method find_method(const Question& question, const std::string& name);

/// The null hypothesis in words and symbols.
std::string null_hypothesis(const Method& method, const Question& question, std::size_t channel);

/// Whether theta of a channel is in units of the reference.
bool is_relative(const Question& question, std::size_t channel);

/// What theta of a channel is divided by: the reference's or the other's |mean| where theta is
/// relative, else 1. `other_mean` is used where the claim compares two.
double unit_of_theta(const Question& question, std::size_t channel, double other_mean);

/// A margin of the claim on theta's own scale: ln(1 + x) for a ratio of variances.
double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin);

/// The evidence on theta of one channel. `data` is one or two subjects'.
Evidence evidence_of(const Method& method, const Question& question, std::size_t channel,
                     std::span<const ChannelData> data);

}  // namespace assay::harness
