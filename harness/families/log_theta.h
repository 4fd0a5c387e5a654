#pragma once

// Families whose theta is the logarithm of a ratio of variances, costs or efficiencies.

#include "harness/families/families.h"

namespace assay::harness {

class LogTheta : public Theta {
 public:
  void check_margin(const Question&, const Margin&) const override;
  std::optional<std::uint64_t> secondaries(const Question&, const ErrorShare&, const Pilots&,
                                           const Plan&) const override;
  std::optional<double> detectable(const Question&, const TestSize&, const Plan&,
                                   const PlannedChannel&) const override;
  std::optional<double> power(const Question&, const TestSize&, const Plan&, const PlannedChannel&,
                              double effect) const override;

 protected:
  explicit LogTheta(ThetaTraits traits, const char* plural)
      : Theta(with_logarithm(traits)), plural_(plural) {}

  /// A channel as the pilots show it; nullopt if it has no spread there.
  virtual std::optional<PlannedChannel> from_pilots(const Question&, std::size_t channel,
                                                    const Pilots&, const Plan&) const = 0;

 private:
  static ThetaTraits with_logarithm(ThetaTraits traits) {
    traits.logarithm = true;
    return traits;
  }

  const char* plural_;
};

}  // namespace assay::harness
