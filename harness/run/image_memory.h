#pragma once

// Whether pictures fit into memory, before they are read.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/prepare.h"

namespace assay::harness {

/// Claims that are answered from rows of their estimators' pictures (picture_stream.h).
using StreamedClaims = std::vector<const Question*>;

/// Bytes that testing the pictures of files takes at its peak, of all these estimators together.
double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed);

/// Bytes that this process may still take: what the system, or the control group that it runs in,
/// has available. Infinity where neither tells.
double available_bytes();

/// Throws InputError at the estimator with most pictures where they need more than `available`:
/// after `fault`, if it is not "", for which they cannot be answered from rows.
void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available,
                    const std::string& fault = "");

}  // namespace assay::harness
