#pragma once

// What a shard's record holds besides its tests, so that `merge` can join the parts.

#include <memory>
#include <vector>

#include "harness/record/record_of.h"

namespace assay::harness {

/// Fills in `record.shard`, and says in the note what a shard's verdicts rest on.
void add_shard(const std::vector<std::unique_ptr<SuiteRun>>& runs, const RunOptions& options,
               reports::Record& record);

/// The options that decide what a run's numbers are, as a command without seed and shard.
std::string options_text(const RunOptions& options);

}  // namespace assay::harness
