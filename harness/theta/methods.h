#pragma once

// The method table: the rows of all families.

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"
#include "harness/theta/decision.h"
#include "stats/cells/chi_square.h"
#include "stats/means/power_exact.h"
#include "stats/planning/looks.h"

namespace assay::harness {

/// A run of consecutive observations, and the time to draw it.
struct Replicate {
  std::uint64_t count = 0;
  stats::Moments moments = {};
  double seconds = 0;
};

/// One subject's data of one channel.
struct ChannelData {
  std::uint64_t primaries = 1;
  stats::Moments moments = {};
  std::span<const double> values = {};                   ///< Set if the method needs them.
  std::vector<std::span<const double>> all_values = {};  ///< Every channel, for Keeps::points.
  std::span<const std::uint64_t> cells = {};
  std::vector<stats::JointMoments> joint = {};  ///< The channel's ChannelDetails::joint.
  stats::Moments group_variances = {};
  /// The cells that a method of Keeps::points counts in; null if the pilots gave none.
  std::shared_ptr<const stats::SampledCells> sampled_cells = {};
  ImageViews images = {};  ///< The subject's elements of each observation.
  std::vector<Replicate> replicates = {};
};

/// A channel of a claim as it was seen, with one entry of data a subject; for a slope, one a point.
struct Seen {
  const Question& question;
  std::size_t channel;
  std::span<const ChannelData> data;

  const stats::Moments& moments(std::size_t subject) const { return data[subject].moments; }
  const Constant& reference() const { return question.references[channel]; }
  bool relative() const;
};

inline bool is_constant(const Seen& seen, std::size_t subject) {
  return is_constant(seen.question.subjects[subject], seen.channel, seen.moments(subject));
}

/// Data that a method needs kept. `points` are the values of all channels together.
enum class Keeps { moments, values, points, cells, powers, costs, group_variances, blocks, images };

inline Powers powers_of(Keeps keeps) {
  if (keeps == Keeps::costs) return Powers::with_costs;
  return keeps == Keeps::powers ? Powers::of_values : Powers::none;
}

/// Replicates of a method that keeps blocks: enough for Student's t to have near-normal tails.
inline constexpr std::uint64_t replicate_count = 32;

struct MethodTraits {
  bool exact = false;               ///< The level holds at every sample size.
  bool in_range = false;            ///< Rests on a channel's declared range.
  bool of_both_ends = false;        ///< Values are the ends of a range.
  bool of_observations = false;     ///< The moments of an earlier run are too little.
  bool of_batches = false;          ///< Tests means of consecutive observations.
  bool corrects_skewness = false;   ///< Corrects for the skewness of the mean.
  bool of_normal_values = false;    ///< Takes values for normal.
  bool of_distinct_values = false;  ///< Coarsely rounded values break its level.
  stats::LookLaw over_looks = stats::LookLaw::unknown;  ///< Of its p-values at several looks.
  const stats::ExactPlanning* plans = nullptr;          ///< Planning of an exact method of a mean.
};

inline constexpr MethodTraits exact_at_any_size{.exact = true};
/// Scores add up over looks (stats/planning/looks.h).
inline constexpr MethodTraits of_scores{.over_looks = stats::LookLaw::independent_increments};

/// A row of the method table (methods.h). Rows of different families of claims may share a name.
struct Method {
  std::string name;
  std::string summary;  ///< Hypothesis and range of validity.
  bool (*answers)(const Question&);
  Keeps keeps;
  /// Null if the family has evidence of its own (Theta::evidence).
  Evidence (*evidence)(const Seen&);
  MethodTraits is = {};
};

const std::vector<Method>& method_table();

/// The methods that answer a question, the default first; `test:` may force any of them.
std::vector<Method> methods_for(const Question& question);

/// The method of that name. Throws InputError at the test's place if it does not answer the
/// question.
Method find_method(const Question& question, const std::string& name);

/// The ends of declared ranges that a claim on means rests on: all by default.
struct Ends {
  bool low = true;
  bool high = true;

  /// True if the range has them.
  bool are_finite(const stats::Range& range) const {
    return (!low || std::isfinite(range.low)) && (!high || std::isfinite(range.high));
  }
};

/// To reject "too much" takes the low end. An alarm with `detect` rejects both.
Ends ends_that_decide(const Question& question);

std::string null_hypothesis(const Question& question, std::size_t channel);

}  // namespace assay::harness
