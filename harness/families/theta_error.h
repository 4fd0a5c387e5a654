#pragma once

#include <optional>
#include <span>

#include "harness/families/methods.h"

namespace assay::harness {

/// Standard errors of theta's estimate where theta = 0. The error `drawn` is new in every run. The
/// error `fixed` is the same in all: a reference's own error, recorded data.
struct ThetaError {
  double drawn = 0;
  double fixed = 0;
};

/// Errors of one channel of a claim on means or variances; nullopt for other claims. Means have s /
/// sqrt(n), over the reference if relative. Logarithms of variances have the delta method's
/// (stats/variances/log_variance.h).
std::optional<ThetaError> theta_error(const Question& question, std::size_t channel,
                                      std::span<const ChannelData> data);

}  // namespace assay::harness
