#pragma once

// The families offer these to the table of quantities and to each other. Each has one file, which
// has Theta, questions, evidence and plans through this one.

#include <cstdint>
#include <string>
#include <vector>

#include "harness/draws/draw_cells.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/theta/theta.h"
#include "stats/laws/law_evidence.h"
#include "stats/variances/influence.h"

namespace assay::harness {

const Theta& theta_of_means();
const Theta& theta_of_biases();
const Theta& theta_of_images();
const Theta& theta_of_image_laws();
const Theta& theta_of_variances();
const Theta& theta_of_costs();
const Theta& theta_of_efficiencies();
const Theta& theta_of_total_variances();
const Theta& theta_of_laws();
const Theta& theta_of_quantiles();
const Theta& theta_of_integrals();
const Theta& theta_of_inconsistencies();
const Theta& theta_of_slopes();
const Theta& theta_of_variance_slopes();

/// Says which compared subject's sample has no spread, so that its error is unknown; "" if all
/// have.
std::string lack_of_spread(const Seen& seen);
/// The mean cost of a primary.
stats::Influence cost_of(const Seen& seen, std::size_t subject);
/// The powers of a channel's values, as far as they are kept: a cost means nothing.
stats::JointMoments powers_of_values(const ChannelData& data);
/// The truth of a subject's mean: its number, or the mean of the drawn reference.
Constant truth_of(const Seen& seen, std::size_t subject);
/// ", red" if the question has several channels.
std::string channel_suffix(const Question& question, std::size_t channel);

const DensityCells& density_of(const Question& question);
stats::Points points_of(const Seen& seen, std::size_t subject);
/// The law that a claim about one sample names, or the sampler's density.
stats::DeclaredLaw declared_law(const Question& question, std::size_t channel);
/// Counts of one side's values in each cell. The last number counts draws without a point.
std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Seen& seen,
                                     std::size_t subject);

/// A channel of one subject before the test.
struct Known {
  std::size_t subject;
  std::size_t channel;
  ChannelData pilot;
  double averaged;  ///< The pilot's values in a secondary.
  bool rows;        ///< The test's own data, not a pilot's.
  std::string label;
};

/// The channels that pilots or rows show, without those that never vary.
std::vector<Known> known_channels(const TestOutcome& test, const Pilots& pilots);

/// Notes a gate of the pilot, but none of rows: they are judged with the test's own data.
void note(Plan& plan, const Known& known, const stats::Gate& gate);

/// Invalid for this reason; nullopt without one.
inline std::optional<ConstantVerdict> invalid(const std::string& why) {
  if (why.empty()) return std::nullopt;
  return ConstantVerdict{reports::Verdict::invalid, why};
}

inline bool is_within(const Question& question) {
  return question.test->claim.relation == Relation::within;
}
inline bool any_question(const Question&) { return true; }
inline bool of_two(const Question& question) { return question.of_two(); }
inline bool of_one(const Question& question) { return !question.of_two(); }

/// The only object of a family with these arguments.
template <class Family, auto... arguments>
const Theta& one() {
  static const Family theta{arguments...};
  return theta;
}

}  // namespace assay::harness
