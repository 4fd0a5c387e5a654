#pragma once

// Whether pictures fit into memory, before they are read.

#include <cstdint>
#include <map>
#include <string>

#include "harness/prepare.h"

namespace assay::harness {

/// Bytes that testing the pictures of files takes at its peak, of all these estimators together.
double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators);

/// Bytes that this process may still take: what the system, or the control group that it runs in,
/// has available. Infinity where neither tells.
double available_bytes();

/// Throws InputError at the estimator with most pictures where they need more than `available`.
void require_memory(const std::map<std::string, PreparedEstimator>& estimators, double available);

}  // namespace assay::harness
