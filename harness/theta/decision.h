#pragma once

// The evidence about theta, the number that a claim is about, gives p-values of the claimed and of
// the forbidden region. From these alone comes the verdict.
//
//  `relation  claimed region C        forbidden region F
//   ==        abs(theta) <= allow     abs(theta) >= detect     alarm
//   <=        theta <= allow          theta >= detect          alarm   (>= mirrored)
//   <         theta < 0               theta >= 0               proof   (> mirrored)
//   within x  abs(theta) < x          abs(theta) >= x          proof`

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/question/question.h"
#include "reports/record/record.h"
#include "stats/tails/evidence.h"

namespace assay::harness {

using stats::Evidence;

/// A part that is the same for every value (Evidence::most_against).
inline std::function<std::string(double)> always(std::string part) {
  return [part = std::move(part)](double) { return part; };
}

/// Margins on theta's scale. `detect` of `within` is its margin. In `<` and `>` it is only the
/// advantage to plan for.
struct Regions {
  Relation relation = Relation::equal;
  double allow = 0;
  std::optional<double> detect = {};

  bool proof() const { return is_proof(relation); }
  bool two_sided() const { return is_two_sided(relation); }
  bool within() const { return relation == Relation::within; }
  /// True if a large theta speaks against the claim, and so for a small one.
  bool bounds_above() const { return two_sided() || is_upper(relation); }
  bool bounds_below() const { return two_sided() || !is_upper(relation); }
  /// True if a pass must exclude a forbidden region.
  bool has_forbidden() const { return proof() || detect.has_value(); }
  /// Sides of the reference where an effect is to be found. An alarm finds what speaks against the
  /// claim, a proof what the claim names.
  std::vector<int> sides() const {
    if (two_sided()) return {1, -1};
    return {bounds_above() != proof() ? 1 : -1};
  }
  bool has_margin() const { return allow != 0 || detect.has_value(); }
  /// The distance of C's ends from 0: 0, `allow` or the margin of `within`.
  double claimed_edge() const;
  /// The distance of F's ends from 0; nullopt if there is no F.
  std::optional<double> forbidden_edge() const;
  /// C with its ends, which may be infinite. For a distance only the upper end counts.
  stats::Range claimed() const { return between(claimed_edge()); }

 private:
  friend double log_p_forbidden(const Evidence& evidence, const Regions& regions);
  /// The values that lie less far out than `edge`, on the sides that the claim bounds.
  stats::Range between(double edge) const;
};

/// Natural logarithm of the p-value of "theta in C".
double log_p_claimed(const Evidence& evidence, const Regions& regions);

/// Natural logarithm of the p-value of "theta in F"; 0 where there is no F.
double log_p_forbidden(const Evidence& evidence, const Regions& regions);

/// The tail of the statistic that speaks against C.
std::string tail(const Regions& regions);

/// Errors that one channel may spend.
struct ErrorShare {
  double alpha = 0;
  double beta = 0;
};

struct ChannelDecision {
  double log_p_claimed = 0;
  double log_p_forbidden = 0;
  bool rejected = false;  ///< Rejects "theta in C".
};
reports::Verdict decide(const std::vector<ChannelDecision>& channels, const Regions& regions,
                        double beta);

}  // namespace assay::harness
