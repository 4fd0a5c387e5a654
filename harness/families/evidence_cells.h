#pragma once

// Evidence about laws from counts in cells. theta = w, Cohen's effect size over the cells.

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "harness/theta/method.h"

namespace assay::harness {

/// Counts of one side's values in each cell. The last number counts draws without a point.
std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Subject& side,
                                     const ChannelData& data);

/// A sampler's draws against its declared density.
Evidence cells_against_density(const Question& question, const ChannelData& data);

/// Two samples against each other in the method's cells. One more cell counts draws without a
/// point. Throws std::domain_error if there are no cells.
Evidence cells_against_cells(const Method& method, const Question& question,
                             std::span<const ChannelData> data);

}  // namespace assay::harness
