#pragma once

// Evidence on efficiencies at counted costs. Of an estimator that is held against a truth the mean
// squared error stands for the variance; what the truth is known to within goes into the p-values
// (stats/uncertain_reference.h).

#include <span>

#include "harness/theta/method.h"

namespace assay::harness {

/// Theta is ln(efficiency / number claimed) or ln(efficiency / other efficiency).
Evidence evidence_of_efficiency(const Question& question, std::size_t channel,
                                std::span<const ChannelData> data);

/// count x the variance of ln efficiency of one subject at the count of its data; what the truth's
/// error adds, which no more data take away, to first and second order.
double efficiency_spread(const Question& question, std::size_t subject, std::size_t channel,
                         std::span<const ChannelData> data);

}  // namespace assay::harness
