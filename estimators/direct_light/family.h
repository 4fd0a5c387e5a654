#pragma once

// The common parameters and the channel of direct lighting.

#include <optional>
#include <vector>

#include "direct_light/exact.h"
#include "estimators/estimator.h"

namespace assay::direct_light {

/// scene and brdf.
std::vector<ParameterInformation> common_parameters();
/// scene, brdf, light_sampling and `more`.
std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more);

struct Parts {
  luminaire::SharedSetting setting;
  SharedReflectance reflectance;
  SharedLightSampling light_sampling;
};
Parts read_parts(Parameters&);
SharedTechniques read_techniques(Parameters&);

/// light_samples and brdf_samples, one or more of each.
std::vector<ParameterInformation> count_parameters();
Counts read_counts(Parameters&);
/// light_probability, in (0, 1).
ParameterInformation probability_parameter();
Pair read_probabilities(Parameters&);

/// The channel `radiance` with its mean, where that is known, and nothing else.
Channel mean_channel(const Techniques&);

struct KnownPrimary {
  std::optional<Known> mean = {};
  std::optional<Known> variance = {};
  double high = 0;  ///< no primary is above
};
/// The channel with the range [0, high] and the mean of the primary. The function mean_channel()
/// gives the mean if it has a closed form or none is given. The variance is stated if it is known
/// to 1e-8.
Channel radiance_channel(const Techniques&, const KnownPrimary&);

/// The most that a draw of the BRDF brings when all the light of the scene is weighted by 1.
double highest_of_brdf(const Techniques&);

}  // namespace assay::direct_light
