#pragma once

// At which levels a test is planned to find what it must reject.

#include "harness/theta/decision.h"
#include "harness/theta/family.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// An alarm rejects the claimed region at alpha and misses with beta. A proof rejects the forbidden
/// region, at beta; within a margin that is both of its sides, each of which misses with beta / 2.
stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions);

}  // namespace assay::harness
