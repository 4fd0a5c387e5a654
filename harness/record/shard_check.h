#pragma once

#include <vector>

#include "harness/record/merge.h"

namespace assay::harness {

/// InputError unless the records are shards of one run, each at most once.
void check_shards(const std::vector<ShardFile>& shards);

}  // namespace assay::harness
