#pragma once

#include <vector>

#include "harness/record/merge.h"

namespace assay::harness {

/// InputError unless the records are all shards of one run, each once.
void check_shards(const std::vector<ShardFile>& shards);

}  // namespace assay::harness
