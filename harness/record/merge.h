#pragma once

// Joins the shards of one run to the record of the whole run.

#include <string>
#include <vector>

#include "harness/record/output.h"
#include "harness/record/record_of.h"

namespace assay::harness {

/// Fills in `record.shard`, which `merge` needs, and adds a note on the basis of a shard's
/// verdicts. `places` are those of each suite's tests in the record.
void add_shard(const SuiteRuns& runs, const RunOptions& options,
               std::vector<std::vector<reports::FamilyResult>> places, reports::Record& record);

struct ShardFile {
  std::string file;
  reports::Record record;
};

/// The record of the whole run, with Holm over each suite's family. It equals one run's record byte
/// for byte, except for suites marked `timed`, times and threads. The first shard gives `started`;
/// the run's `seconds` are the sum. Shards may come in any order. The tests of a missing shard are
/// skipped. InputError with file names for a record that is no shard, and for a doubled shard.
/// InputError also for different suites, data files, seeds, options, versions or instruction sets.
reports::Record merge(std::vector<ShardFile> shards);

/// Reads, merges and reports. Returns the exit code of the whole run, 1 if a shard is missing.
int merge_shards(const std::vector<std::string>& records, const Output& output);

}  // namespace assay::harness
