#include "harness/theta/decision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/means/equivalence.h"

namespace assay::harness {
namespace {

double log_p_at_most(const Evidence& evidence, double value) {
  return evidence.at(value).log_p_upper;
}

double log_p_at_least(const Evidence& evidence, double value) {
  return evidence.at(value).log_p_lower;
}

/// p of "-margin <= theta <= margin".
double log_p_between(const Evidence& evidence, double margin) {
  if (evidence.distance) return log_p_at_most(evidence, margin);
  const double smaller =
      std::min(log_p_at_most(evidence, margin), log_p_at_least(evidence, -margin));
  return std::min(0.0, std::log(2.0) + smaller);
}

/// p of "abs(theta) >= margin": two one-sided tests, each at the full level.
double log_p_outside(const Evidence& evidence, double margin) {
  if (evidence.distance) return log_p_at_least(evidence, margin);
  return stats::equivalence(evidence.at(-margin), evidence.at(margin)).log_p;
}

/// p of "theta < 0" and "theta > 0": that of the closed region, unless theta is exactly 0.
double log_p_beside(const Evidence& evidence, double log_p_closed) {
  constexpr double impossible = std::numeric_limits<double>::lowest();
  const bool at_the_end =
      evidence.exact && log_p_at_most(evidence, 0) == 0 && log_p_at_least(evidence, 0) == 0;
  return at_the_end ? impossible : log_p_closed;
}

}  // namespace

bool Regions::proof() const {
  return relation == Relation::less || relation == Relation::greater ||
         relation == Relation::within;
}

bool Regions::two_sided() const {
  return relation == Relation::equal || relation == Relation::within;
}

double log_p_claimed(const Evidence& evidence, const Regions& regions) {
  switch (regions.relation) {
    case Relation::equal:
      return log_p_between(evidence, regions.allow);
    case Relation::at_most:
      return log_p_at_most(evidence, regions.allow);
    case Relation::at_least:
      return log_p_at_least(evidence, -regions.allow);
    case Relation::less:
      return log_p_beside(evidence, log_p_at_most(evidence, 0));
    case Relation::greater:
      return log_p_beside(evidence, log_p_at_least(evidence, 0));
    case Relation::within:
      return log_p_between(evidence, regions.within);
  }
  return 0;
}

double log_p_forbidden(const Evidence& evidence, const Regions& regions) {
  switch (regions.relation) {
    case Relation::equal:
      return regions.detect ? log_p_outside(evidence, *regions.detect) : 0;
    case Relation::at_most:
      return regions.detect ? log_p_at_least(evidence, *regions.detect) : 0;
    case Relation::at_least:
      return regions.detect ? log_p_at_most(evidence, -*regions.detect) : 0;
    case Relation::less:
      return log_p_at_least(evidence, 0);
    case Relation::greater:
      return log_p_at_most(evidence, 0);
    case Relation::within:
      return log_p_outside(evidence, regions.within);
  }
  return 0;
}

double edge_of_claimed(const Regions& regions) {
  if (regions.relation == Relation::within) return regions.within;
  return regions.proof() ? 0 : regions.allow;
}

std::string tail(const Regions& regions) {
  switch (regions.relation) {
    case Relation::at_most:
    case Relation::less:
      return "upper";
    case Relation::at_least:
    case Relation::greater:
      return "lower";
    case Relation::equal:
    case Relation::within:
      break;
  }
  return "two-sided";
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
