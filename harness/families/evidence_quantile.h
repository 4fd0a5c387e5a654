#pragma once

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Theta is quantile - v, or quantile x - factor * quantile y; relative margins divide it by |v|.
/// Exact for every law.
Evidence evidence_of_quantile(const Question& question, std::size_t channel,
                              std::span<const ChannelData> data);

}  // namespace assay::harness
