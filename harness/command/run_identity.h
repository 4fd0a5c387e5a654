#pragma once

#include <vector>

#include "harness/base/identity.h"
#include "harness/suite/run_options.h"
#include "harness/suite/suite.h"

namespace assay::harness {

/// All that decides the numbers of a run: version, machine code, seed, options, and the files that
/// suites name. Of a file it takes the size and the first mebibyte.
Identity identity_of(const std::vector<Suite>& suites, const RunOptions& options);

}  // namespace assay::harness
