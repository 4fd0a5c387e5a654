#pragma once

// Callables as the harness's estimators.

#include <string>

#include "harness/googletest/claims.h"
#include "harness/sampling/prepare.h"

namespace assay::googletest {

/// `stream` tells its random numbers from those of every other source of the binary.
harness::PreparedEstimator prepared(const Source& source, const std::string& stream);

}  // namespace assay::googletest
