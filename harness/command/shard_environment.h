#pragma once

// The shard that a test runner asks for by its environment, as GoogleTest and Bazel have it.

#include "harness/base/environment_variables.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

/// Unless the options name a shard: that of GTEST_TOTAL_SHARDS and GTEST_SHARD_INDEX (from 0), else
/// of TEST_TOTAL_SHARDS and TEST_SHARD_INDEX; one shard in all is a whole run. The files that
/// GTEST_SHARD_STATUS_FILE and TEST_SHARD_STATUS_FILE name are made, by which the runner learns
/// that its shards are known. InputError for one variable without the other, or values that are no
/// shard.
void take_shard_from(const Environment& environment, RunOptions& options);

}  // namespace assay::harness
