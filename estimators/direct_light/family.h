#pragma once

// The common parameters and the channel of direct lighting.

#include <memory>
#include <optional>
#include <vector>

#include "direct_light/exact.h"
#include "estimators/estimator.h"

namespace assay::direct_light {

/// scene and brdf.
std::vector<ParameterInformation> common_parameters();
/// scene, brdf, light_sampling and `more`.
std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more);

/// Reads what parameters_with() declares; `Kind` is made as Techniques is.
template <class Kind = Techniques>
std::shared_ptr<const Kind> read_techniques(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  const SharedReflectance reflectance = read_reflectance(given);
  return std::make_shared<const Kind>(setting, reflectance, read_light_sampling(given, setting));
}

/// Reads light_samples and brdf_samples, one or more of each.
Counts read_counts(Parameters&);
/// Reads light_probability, in (0, 1).
Pair read_probabilities(Parameters&);

/// The channel `radiance` with its mean, where that is known, and nothing else.
Channel mean_channel(const std::optional<Known>& radiance);

}  // namespace assay::direct_light
