#include "harness/theta/decision.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace assay::harness {
double Regions::claimed_edge() const {
  if (within()) return detect.value_or(0);
  return proof() ? 0 : allow;
}

std::optional<double> Regions::forbidden_edge() const {
  return proof() && !within() ? std::optional(0.0) : detect;
}

stats::Range Regions::between(double edge) const {
  return {bounds_below() ? -edge : -HUGE_VAL, bounds_above() ? edge : HUGE_VAL};
}

double log_p_claimed(const Evidence& evidence, const Regions& regions) {
  const stats::Range claimed = regions.claimed();
  if (evidence.distance) return evidence.at(claimed.high).log_p_upper;
  const double above = regions.bounds_above() ? evidence.at(claimed.high).log_p_upper : 0;
  const double below = regions.bounds_below() ? evidence.at(claimed.low).log_p_lower : 0;
  if (regions.two_sided()) return std::min(0.0, std::log(2.0) + std::min(above, below));
  // p of "theta < 0" or "theta > 0" is that of the closed region, unless theta is exactly 0.
  const bool is_exactly_0 = regions.proof() && evidence.exact && evidence.at(0).log_p_upper == 0 &&
                            evidence.at(0).log_p_lower == 0;
  return is_exactly_0 ? std::numeric_limits<double>::lowest() : std::min(above, below);
}

double log_p_forbidden(const Evidence& evidence, const Regions& regions) {
  const std::optional<double> edge = regions.forbidden_edge();
  if (!edge) return 0;
  const stats::Range allowed = regions.between(*edge);
  if (evidence.distance || !regions.bounds_below()) return evidence.at(allowed.high).log_p_lower;
  if (!regions.bounds_above()) return evidence.at(allowed.low).log_p_upper;
  // Two one-sided tests, each at the full level.
  return stats::log_p_equivalence(evidence.at(allowed.low), evidence.at(allowed.high));
}

std::string tail(const Regions& regions) {
  if (regions.two_sided()) return "two-sided";
  return regions.bounds_above() ? "upper" : "lower";
}

reports::Verdict decide(const std::vector<ChannelDecision>& channels, const Regions& regions,
                        double beta) {
  bool excluded = true;
  for (const ChannelDecision& channel : channels) {
    if (channel.rejected) return reports::Verdict::fail;
    if (regions.has_forbidden()) excluded = excluded && channel.log_p_forbidden <= std::log(beta);
  }
  return excluded ? reports::Verdict::pass : reports::Verdict::inconclusive;
}

}  // namespace assay::harness
