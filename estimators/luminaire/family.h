#pragma once

// The common parameter, channel and samplers of the luminaire estimators.
//
// All estimate the irradiance at a receiver from a diffuse luminaire,
//   E = integral over directions w of L(w) max(0, n . w).
// L(w) is the radiance of the luminaire if a ray along w hits it first, else 0. Parts of the
// luminaire below the receiver's horizon, and sides that do not emit, contribute nothing.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "estimators/estimator.h"
#include "luminaire/exact.h"
#include "luminaire/setting.h"

namespace assay::luminaire {

using SharedSetting = std::shared_ptr<const Setting>;

/// The parameter `scene`, common to the family, and static information with it.
ParameterInformation scene_parameter();
Information information(std::string name, std::string summary, std::string description);

SharedSetting read_setting(Parameters& parameters);

/// E[X^2] for unit radiance of the primary X, if it can be had from the exact integrals.
using SecondMoment = std::function<std::optional<double>(const ExactIntegrals&)>;

/// The channel `irradiance` with all that is known exactly: the mean; the variance where
/// subtracting the squared mean leaves ten digits; between 0 and `high`.
Channel irradiance_channel(const Setting& setting, const SecondMoment& second_moment, double high);

}  // namespace assay::luminaire
