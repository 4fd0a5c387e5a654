#include "harness/plan/planned_rates.h"

#include "harness/theta/decision.h"
namespace assay::harness {

stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions) {
  if (regions.relation == Relation::within) {
    return {.alpha = share.beta, .beta = share.beta / 2, .two_sided = false};
  }
  if (regions.proof()) return {.alpha = share.beta, .beta = share.beta, .two_sided = false};
  return {.alpha = share.alpha, .beta = share.beta, .two_sided = regions.two_sided()};
}

}  // namespace assay::harness
