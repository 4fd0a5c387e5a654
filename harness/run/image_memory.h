#pragma once

// Checks that pictures fit into memory before they are read.

#include <map>
#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/prepare.h"

namespace assay::harness {

/// Claims that are answered row by row (picture_stream.h).
using StreamedClaims = std::vector<const Question*>;

/// Peak bytes of testing the picture files of all these estimators.
double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed);

/// Bytes that this process may still take, by the system or its control group. Infinity if unknown.
double available_bytes();

/// InputError at the estimator with most pictures if they need more than `available`. The message
/// begins with `fault`, if any: why they cannot be read row by row.
void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available,
                    const std::string& fault = "");

}  // namespace assay::harness
