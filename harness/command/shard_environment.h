#pragma once

// Takes the shard from a test runner's environment, as GoogleTest and Bazel do.

#include "harness/base/environment_variables.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

/// Does nothing if the options name a shard. It reads GTEST_TOTAL_SHARDS and GTEST_SHARD_INDEX
/// (from 0), else TEST_TOTAL_SHARDS and TEST_SHARD_INDEX; a total of 1 is a whole run. It makes the
/// files that GTEST_SHARD_STATUS_FILE and TEST_SHARD_STATUS_FILE name, which tell the runner that
/// shards work. InputError for one variable without the other, or an invalid shard.
void take_shard_from(const Environment& environment, RunOptions& options);

}  // namespace assay::harness
