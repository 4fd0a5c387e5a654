#pragma once

// Adds to a shard's record what `merge` needs to join the parts.

#include <memory>
#include <vector>

#include "harness/record/record_of.h"

namespace assay::harness {

/// Fills in `record.shard`, and adds a note on the basis of a shard's verdicts.
void add_shard(const std::vector<std::unique_ptr<SuiteRun>>& runs, const RunOptions& options,
               reports::Record& record);

}  // namespace assay::harness
