#pragma once

#include <cstdint>
#include <optional>

#include "harness/outcome.h"
#include "harness/pilot.h"
#include "stats/bounded_mean.h"

namespace assay::harness {

/// What planning takes a channel's law to be: a secondary's standard deviation and kurtosis at the
/// upper limit of what the pilot allows, and the value margins are relative to.
struct PlannedChannel {
  Regions regions = {};
  double standard_deviation = 0;
  double other_deviation = 0;  ///< of the second subject, times the factor
  double kurtosis = 3;
  double other_kurtosis = 1;  ///< 1: there is no second subject
  double unit = 1;            ///< theta times this is in the estimator's unit
  double reference_error = 0;
  bool unseen = false;      ///< the deviation is what a pilot without spread may not have seen
  stats::Range range = {};  ///< of one mean: what its values are declared to lie in
  double null_value = 0;    ///< of one mean: where theta is 0
};

/// A look of a test, at its levels: secondaries of each subject, or all that it has.
struct TestSize {
  ErrorShare share;
  std::uint64_t secondaries;
};

/// More secondaries than any test is given: what is planned beyond is impossible.
inline constexpr std::uint64_t impossible_secondaries = std::uint64_t{1} << 53;

/// Secondaries of each subject that find `detect` (or prove `within`) with this share of alpha and
/// beta in every channel; nullopt where nothing asks for a number: no `detect`, or no pilot.
/// `impossible_secondaries` where no number would do, the reference's own error being too large.
std::optional<std::uint64_t> planned_secondaries(const Question& question, const ErrorShare& share,
                                                 const Pilots& pilots, const Plan& plan);

/// What the pilots say of a claim on costs, efficiencies or total variances, the worst over its
/// channels: 1 + the spread of each side's logarithm stands for a kurtosis. nullopt for other
/// claims, where an estimator has no pilot, and where nothing spreads: exact costs.
std::optional<PlannedChannel> planned_log_channel(const Question& question, const Regions& regions,
                                                  const Pilots& pilots, const Plan& plan);

/// The least theta that a test of that size finds with probability 1 - beta.
std::optional<double> detectable_effect(const Question& question, const TestSize& size,
                                        const Plan& plan, const PlannedChannel& channel);

/// Whether no theta that a declared range allows is found with probability 1 - beta.
bool finds_nothing(const Question& question, const TestSize& size, const Plan& plan,
                   const PlannedChannel& channel);

/// The probability of failing the claim when theta is `effect`; of `<` and `>` the probability of
/// passing it with that advantage, of `within` that of passing it when theta is 0.
std::optional<double> power_at(const Question& question, const TestSize& size, const Plan& plan,
                               const PlannedChannel& channel, double effect);

/// A channel from the test's own data, for what is reported about its n.
PlannedChannel observed_channel(const Question& question, const Regions& regions,
                                std::size_t channel, std::span<const ChannelData> data);

}  // namespace assay::harness
