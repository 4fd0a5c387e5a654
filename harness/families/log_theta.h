#pragma once

// Families whose theta is the logarithm of a ratio of positive quantities: variances, costs,
// efficiencies. Each quantity is known by its influence values (stats/variances/influence.h).

#include <functional>
#include <vector>

#include "harness/families/families.h"
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

/// Theta is ln(first / second / null), or ln(first / null), or minus that.
struct LogRatio {
  std::vector<RatioSide> sides;
  bool shares_truth = false;  ///< One truth, with one error, serves both sides.
  double log_null = 0;
  bool inverse = false;  ///< The quantities are inverses of efficiencies.
  const char* quantity = "";
};
Evidence evidence_of(const LogRatio& ratio);

/// A pilot of single primaries.
struct PilotMoments {
  const stats::Moments& values;
  std::vector<stats::JointMoments> joint;
};

/// The variance of one observation's influence values of a variance, over its square. It is 2 for a
/// normal law. A mean's excess kurtosis falls like 1 / its size.
double averaged_spread(double of_one, double averaged);

/// The row of the one method of influence values, for a family that keeps and reads them so.
MethodRow influence_row(bool (*answers)(const Question&), Keeps keeps,
                        decltype(MethodRow::evidence) evidence);

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
  std::vector<Gate> gates(const TestOutcome&, std::size_t channel, std::span<const ChannelData>,
                          double critical) const override;

 protected:
  explicit LogTheta(ThetaTraits traits, const char* plural)
      : Theta(with_logarithm(traits)), plural_(plural) {}

  /// A subject's influence values, with the truth as known; nullopt if the data do not tell.
  virtual std::optional<stats::Influence> influence(const Question&, std::size_t subject,
                                                    std::size_t channel,
                                                    std::span<const ChannelData>) const = 0;
  /// The variance of an observation's influence values over the quantity's square, for observations
  /// of `averaged` of the pilot's primaries.
  virtual std::optional<double> predicted_spread(const Question&, const PilotMoments&,
                                                 double averaged) const = 0;
  /// The same from the test's own data.
  virtual std::optional<double> spread(const Question&, std::size_t subject, std::size_t channel,
                                       std::span<const ChannelData>) const;
  /// Count times the variance that the truth's own error makes.
  virtual double spread_of_truth(const Question&, std::size_t, std::size_t,
                                 std::span<const ChannelData>) const {
    return 0;
  }

 private:
  static ThetaTraits with_logarithm(ThetaTraits traits) {
    traits.logarithm = true;
    return traits;
  }
  /// The plan of one channel, or of the worst; nullopt if a pilot has no spread there.
  std::optional<PlannedChannel> from_pilots(const Question&, std::optional<std::size_t> channel,
                                            const Regions&, const Pilots&, const Plan&) const;
  std::optional<double> pilot_spread(const Question&, std::size_t subject,
                                     std::optional<std::size_t> channel, const Pilots&,
                                     const Plan&) const;

  const char* plural_;
};

}  // namespace assay::harness
