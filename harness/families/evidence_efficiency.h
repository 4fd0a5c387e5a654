#pragma once

// Evidence on efficiencies at counted costs. Against a truth, the mean squared error stands for the
// variance, and the truth's error enters the p-values (stats/means/uncertain_reference.h).

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Theta is ln(efficiency / number claimed) or ln(efficiency / other efficiency).
Evidence evidence_of_efficiency(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data);

/// Count times the variance of ln efficiency of one subject, at the count of its data. It includes
/// the truth's error to first and second order, which more data do not reduce.
double efficiency_spread(const Question& question, std::size_t subject, std::size_t channel,
                         std::span<const ChannelData> data);

}  // namespace assay::harness
