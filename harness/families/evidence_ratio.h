#pragma once

// Evidence on quantities that are compared as ratios: costs, efficiencies, total variances. Theta
// is the natural logarithm of the ratio, first over second or over the number claimed.

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Cost, efficiency and total variance from counts; asymptotic, from 1000 observations on.
Evidence evidence_of_ratio(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data);

/// Cost and efficiency in seconds, from the replicates of `data`: Student's or Welch's t on the
/// logarithms of their costs, or of cost x variance. The logarithm's expectation differs from that
/// of the variance's logarithm by about 1 / replicate size, alike on both sides.
Evidence evidence_of_replicates(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data);

/// Of values with each counted cost those with the test's, rays or samples.
const stats::JointMoments& by_its_cost(const Question& question,
                                       std::span<const stats::JointMoments> with_cost);

/// Values with what they cost, in rays or samples as the test says. std::domain_error where nothing
/// was counted.
const stats::JointMoments& counted_cost(const Question& question, const ChannelData& data);

/// count x the variance of the logarithm of one subject's cost, efficiency or total variance: what
/// plans and powers need. Nothing where it cannot be computed.
std::optional<double> log_spread(const Question& question, std::size_t subject, std::size_t channel,
                                 std::span<const ChannelData> data);

/// The same expected of secondaries of so many primaries, from a pilot of one.
struct PilotMoments {
  const stats::Moments& values;
  const std::vector<stats::JointMoments>& with_cost;
};
std::optional<double> planned_log_spread(const Question& question, const PilotMoments& pilot,
                                         double averaged);

/// The truth of a subject's mean: its number, or the mean of the reference that was drawn.
Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data);

}  // namespace assay::harness
