#pragma once

// Levels at which a test is planned to find what it must reject.

#include "harness/theta/decision.h"
#include "stats/planning/power.h"

namespace assay::harness {

/// An alarm rejects the claimed region at alpha and misses with beta. A proof rejects the forbidden
/// region at beta. For `within` both sides are rejected, and each misses with beta / 2.
stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions);

}  // namespace assay::harness
