#pragma once

#include <optional>
#include <span>

#include "harness/families/methods.h"

namespace assay::harness {

/// Standard errors of the estimate of theta where theta = 0: what is drawn anew in every run, and
/// what is the same in all of them (a reference's own error, recorded data).
struct ThetaError {
  double drawn = 0;
  double fixed = 0;
};

/// Of one channel of a claim on means or variances; nullopt for other claims. Of a relative
/// difference of means s / sqrt(n) over the reference, of a logarithm of a variance the delta
/// method's (stats/log_variance.h).
std::optional<ThetaError> theta_error(const Question& question, std::size_t channel,
                                      std::span<const ChannelData> data);

}  // namespace assay::harness
