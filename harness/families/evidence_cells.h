#pragma once

// Evidence about laws from counts in cells. theta = w, Cohen's effect size over the cells.

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "harness/theta/method.h"

namespace assay::harness {

/// How many of one side's values lie in each cell; the last number is of draws without a point.
std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Subject& side,
                                     const ChannelData& data);

/// A sampler's draws against the density that it declares.
Evidence cells_against_density(const Question& question, const ChannelData& data);

/// Two samples against each other in the cells that the method has from the pilots, one more for
/// draws that yield no point. Throws std::domain_error where there are none.
Evidence cells_against_cells(const Method& method, const Question& question,
                             std::span<const ChannelData> data);

}  // namespace assay::harness
