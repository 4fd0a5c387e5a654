#pragma once

// Evidence on costs, efficiencies and total variances. Theta is the natural logarithm of a ratio:
// first over second, or over the claimed number.

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Counted cost, efficiency and total variance; asymptotic, valid from 1000 observations on.
Evidence evidence_of_ratio(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

/// Cost and efficiency in seconds, from replicates: Student's or Welch's t on the logarithms of
/// their costs, or of cost x variance. The mean logarithm is off by about 1 / replicate size, alike
/// on both sides.
Evidence evidence_of_replicates(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data);

/// The values with the cost that the test counts, rays or samples.
const stats::JointMoments& by_its_cost(const Question& question,
                                       std::span<const stats::JointMoments> with_cost);

/// Values with their cost, in rays or samples. Throws std::domain_error if nothing was counted.
const stats::JointMoments& counted_cost(const Question& question, const ChannelData& data);

/// Count times the variance of one subject's ln cost, ln efficiency or ln total variance, for plans
/// and powers. Returns nullopt if it cannot be computed.
std::optional<double> log_spread(const Question& question, std::size_t subject, std::size_t channel,
                                 std::span<const ChannelData> data);

/// A pilot of single primaries. `planned_log_spread` predicts log_spread of secondaries of
/// `averaged` such primaries.
struct PilotMoments {
  const stats::Moments& values;
  const std::vector<stats::JointMoments>& with_cost;
};
std::optional<double> planned_log_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged);

/// The truth of a subject's mean: its number, or the mean of the drawn reference.
Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data);

}  // namespace assay::harness
