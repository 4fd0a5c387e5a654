#pragma once

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Theta is quantile - v, or quantile x - factor * quantile y: exact for every law, from the
/// values. Relative, where the claim's margins are, to the number v.
Evidence evidence_of_quantile(const Question& question, std::size_t channel,
                              std::span<const ChannelData> data);

}  // namespace assay::harness
