#pragma once

// Families whose theta is the logarithm of a ratio of positive quantities: variances, costs,
// efficiencies. Each quantity is known by its influence values (stats/variances/influence.h).

#include <functional>
#include <span>
#include <vector>

#include "harness/families/families.h"
#include "harness/plan/outcome.h"
#include "stats/means/uncertain_reference.h"
#include "stats/variances/influence.h"

namespace assay::harness {

/// One side of a ratio.
struct RatioSide {
  std::function<stats::Influence(double truth)> influence;
  /// The truth of a mean squared error; other quantities have none.
  stats::UncertainReference truth = {};
};

/// A side that no truth enters.
RatioSide without_truth(const stats::Influence& influence);

/// The words for a quantity: "cost" and "costs".
struct RatioWords {
  const char* one;
  const char* many;
};

/// A pilot of single primaries.
struct PilotMoments {
  const stats::Moments& values;
  std::vector<stats::JointMoments> joint;
};

/// The variance of one observation's influence values of a variance, over its square. It is 2 for a
/// normal law. A mean's excess kurtosis falls like 1 / its size.
double averaged_spread(double of_one, double averaged);

/// The row of the one method of influence values, for a family that keeps them so.
MethodRow influence_row(bool (*answers)(const Question&), Keeps keeps);

/// The name of theta before its logarithm: "ratio of costs", "cost over the reference".
std::string quantity_of(const Question& question);

class LogTheta : public Theta {
 public:
  void check_margin(const Question&, const Margin&) const override;
  std::optional<ThetaError> error(const Question&, std::size_t channel,
                                  std::span<const ChannelData>) const override;
  std::uint64_t choose(const Question&, const FamilyPlace&, const Pilots&, std::uint64_t most,
                       Plan&) const override;
  std::optional<std::uint64_t> secondaries(const Question&, const ErrorShare&, const Pilots&,
                                           const Plan&) const override;
  std::optional<PlannedChannel> planned(const Question&, const Regions&, const Pilots&,
                                        const Plan&) const override;
  PlannedChannel observed(const Question&, const Regions&, std::size_t channel,
                          std::span<const ChannelData>) const override;
  std::optional<double> detectable(const Question&, const TestSize&, const Plan&,
                                   const PlannedChannel&) const override;
  std::optional<double> power(const Question&, const TestSize&, const Plan&, const PlannedChannel&,
                              double effect) const override;
  std::string lack_of_numbers(const DrawnTest&, std::size_t channel,
                              std::span<const ChannelData>) const override;
  std::vector<Gate> gates(const TestOutcome&, std::size_t channel, std::span<const ChannelData>,
                          double critical) const override;

 protected:
  LogTheta(ThetaTraits traits, RatioWords words) : Theta(with_logarithm(traits)), words_(words) {}

  /// A subject's side of the ratio. Throws std::domain_error if it has none.
  virtual RatioSide side(const Question&, std::size_t subject, std::size_t channel,
                         std::span<const ChannelData>) const = 0;
  /// True if the data tell a subject's influence values.
  virtual bool tells(const ChannelData&) const = 0;
  /// ln of the ratio, or of the one quantity, where theta is 0.
  virtual double log_null(const Question&, std::size_t channel, std::span<const ChannelData>) const;
  /// True if sides are inverses of the quantities.
  virtual bool is_inverse() const { return false; }

  /// The variance of an observation's influence values over the quantity's square, for observations
  /// of `averaged` of the pilot's primaries; by default that of a variance.
  virtual std::optional<double> predicted_spread(const Question&, const PilotMoments&,
                                                 double averaged) const;
  /// The same from the test's own data.
  virtual std::optional<double> spread(const Question&, std::size_t subject, std::size_t channel,
                                       std::span<const ChannelData>) const;
  /// Count times the variance that the truth's own error makes.
  virtual double spread_of_truth(const Question&, std::size_t, std::size_t,
                                 std::span<const ChannelData>) const {
    return 0;
  }

 private:
  friend std::string quantity_of(const Question& question);
  friend Evidence by_influence(const Method&, const Question&, std::size_t channel,
                               std::span<const ChannelData>);
  static ThetaTraits with_logarithm(ThetaTraits traits) {
    traits.logarithm = true;
    return traits;
  }
  /// A subject's influence values, with the truth as known; nullopt if the data do not tell.
  std::optional<stats::Influence> influence(const Question&, std::size_t subject,
                                            std::size_t channel,
                                            std::span<const ChannelData>) const;
  /// The plan of one channel, or of the worst; nullopt if a pilot has no spread there.
  std::optional<PlannedChannel> from_pilots(const Question&, std::optional<std::size_t> channel,
                                            const Regions&, const Pilots&, const Plan&) const;
  std::optional<double> pilot_spread(const Question&, std::size_t subject,
                                     std::optional<std::size_t> channel, const Pilots&,
                                     const Plan&) const;

  const RatioWords words_;
};

// Counted costs, and the truth of a biased estimator's mean.

/// The values with the cost that the test counts, rays or samples.
const stats::JointMoments& by_its_cost(const Question& question,
                                       std::span<const stats::JointMoments> joint);

/// Values with their cost, in rays or samples. Throws std::domain_error if nothing was counted.
const stats::JointMoments& counted_cost(const Question& question, const ChannelData& data);

/// The powers of a channel's values, as far as they are kept: a cost means nothing.
stats::JointMoments powers_of_values(const ChannelData& data);

/// The truth of a subject's mean: its number, or the mean of the drawn reference.
Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data);

}  // namespace assay::harness
