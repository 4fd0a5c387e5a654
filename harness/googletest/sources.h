#pragma once

// Wraps callables as the harness's estimators.

#include <string>

#include "harness/googletest/claims.h"
#include "harness/sampling/prepare.h"

namespace assay::googletest {

/// `stream` separates its random numbers from those of the binary's other sources.
harness::PreparedEstimator prepared(const Source& source, const std::string& stream);

}  // namespace assay::googletest
