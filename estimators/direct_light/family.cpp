#include "direct_light/family.h"

#include "estimators/parameters.h"

namespace assay::direct_light {

std::vector<ParameterInformation> common_parameters() {
  return {luminaire::scene_parameter(), brdf_parameter()};
}

std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more) {
  return joined(joined(common_parameters(), {light_sampling_parameter()}), more);
}

std::vector<ParameterInformation> count_parameters() {
  return {count_parameter("light_samples", "samples of the light in a primary", "1", {1, 1000}),
          count_parameter("brdf_samples", "samples of the BRDF in a primary", "1", {1, 1000})};
}

Counts read_counts(Parameters& given) {
  return {.light = given.count("light_samples"), .brdf = given.count("brdf_samples")};
}

ParameterInformation probability_parameter() {
  return {.name = "light_probability",
          .summary = "probability that the light is sampled, not the BRDF",
          .fallback = "0.5",
          .range = {.low = 0, .high = 1, .low_excluded = true, .high_excluded = true},
          .reason = "a technique that is never chosen leaves nothing to combine"};
}

Pair read_probabilities(Parameters& given) {
  const double light = given.number("light_probability");
  return {light, 1 - light};
}

Channel mean_channel(const std::optional<Known>& radiance) {
  Channel channel{.name = "radiance"};
  if (radiance) {
    channel.mean = radiance->value;
    channel.mean_error = radiance->error;
  }
  return channel;
}

}  // namespace assay::direct_light
