#pragma once

// From evidence about theta to p-values of the claimed and the forbidden region, and a verdict.
//
//   relation  claimed region C        forbidden region F
//   ==        abs(theta) <= allow     abs(theta) >= detect     alarm
//   <=        theta <= allow          theta >= detect          alarm   (>= mirrored)
//   <         theta < 0               theta >= 0               proof   (> mirrored)
//   within x  abs(theta) < x          abs(theta) >= x          proof

#include <optional>

#include "harness/language/claim.h"
#include "harness/theta/evidence.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Margins on theta's scale. In `<` and `>`, `detect` is only the advantage to plan for.
struct Regions {
  Relation relation = Relation::equal;
  double allow = 0;
  std::optional<double> detect = {};
  double within = 0;

  bool proof() const;
  bool two_sided() const;
  /// True if a pass must exclude a forbidden region.
  bool has_forbidden() const { return proof() || detect.has_value(); }
  bool has_margin() const {
    return allow != 0 || detect.has_value() || relation == Relation::within;
  }
};

/// Natural logarithm of the p-value of "theta in C".
double log_p_claimed(const Evidence& evidence, const Regions& regions);

/// Natural logarithm of the p-value of "theta in F"; 0 where there is no F.
double log_p_forbidden(const Evidence& evidence, const Regions& regions);

/// The upper end of C: 0, `allow` or the margin of `within`. For a distance it is the only end.
double edge_of_claimed(const Regions& regions);

/// The tail of the statistic that speaks against C.
std::string tail(const Regions& regions);

/// Errors that one channel may spend.
struct ErrorShare {
  double alpha = 0;
  double beta = 0;
};

/// One channel's p-values. `decide` turns those of all channels into fail, pass or inconclusive.
struct ChannelDecision {
  double log_p_claimed = 0;
  double log_p_forbidden = 0;
  bool rejected = false;  ///< Rejects "theta in C".
};
reports::Verdict decide(const std::vector<ChannelDecision>& channels, const Regions& regions,
                        double beta);

}  // namespace assay::harness
