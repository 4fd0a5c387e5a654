#pragma once

// The environment may ask something of the process. A launcher, such as mpirun or srun, has tasks
// to join to one run. A test runner, such as GoogleTest or Bazel, has shards.

#include <string>
#include <vector>

#include "harness/base/terminal.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

/// How many tasks of this command a launcher's environment tells of; 1 without one.
unsigned launched_tasks();

/// Replaces the process by `assay-mpi` beside `assay`, which joins tasks to one run, if it is one
/// of several tasks of a command that samples. Returns if it is not; InputError if that program is
/// missing.
void join_tasks(const std::vector<std::string>& arguments);

/// Does nothing if the options name a shard. It reads GTEST_TOTAL_SHARDS and GTEST_SHARD_INDEX
/// (from 0), else TEST_TOTAL_SHARDS and TEST_SHARD_INDEX; a total of 1 is a whole run. It makes the
/// files that GTEST_SHARD_STATUS_FILE and TEST_SHARD_STATUS_FILE name, which tell the runner that
/// shards work. InputError for one variable without the other, or an invalid shard.
void take_shard_from(const Environment& environment, RunOptions& options);

}  // namespace assay::harness
