#pragma once

// Which tests of a run a shard takes. Every shard draws the pilots of all selected tests and deals
// the tests in the same way, from the suites and the seed alone.

#include <memory>
#include <utility>
#include <vector>

#include "harness/run/suite_run.h"

namespace assay::harness {

/// Leaves the planned tests of shard I of N, counted from 1; `elsewhere` names the others.
///
/// A test costs the expected observations of its streams, each by its rays and samples in the
/// pilot. Tests of one stream share their observations: the longest prefix counts. The dearest test
/// is dealt first (Graham 1969). It goes where it adds least, among the shards that stay near a
/// fair part. If none does, it goes to the shard that has least to draw with it.
void keep_shard(const std::vector<std::unique_ptr<SuiteRun>>& runs,
                std::pair<unsigned, unsigned> shard);

}  // namespace assay::harness
