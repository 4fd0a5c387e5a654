#pragma once

// Shards of one run joined to the record that the run would have left.

#include <string>
#include <vector>

#include "harness/record/output.h"

namespace assay::harness {

/// A shard's record and the file it was read from.
struct ShardFile {
  std::string file;
  reports::Record record;
};

/// The record of the whole run, with Holm over each suite's family: what one run of the same
/// command leaves, byte for byte, but for what `reports::without_times` clears (and for suites
/// whose record says `timed`). `started` is the first shard's, `seconds` and the seconds of costs
/// are as the shards had them, `seconds` of the run their sum. Shards may come in any order.
/// InputError that names the files for a record that is no shard, shards of different suites, data
/// files, seeds, options, versions or instruction sets, and a missing or doubled shard.
reports::Record merge(std::vector<ShardFile> shards);

struct MergeArguments {
  std::vector<std::string> records;
};
/// Reads, merges, reports; the exit code is that of the whole run.
int merge_shards(const MergeArguments& arguments, const Output& output);

}  // namespace assay::harness
