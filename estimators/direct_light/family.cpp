#include "direct_light/family.h"

#include "estimators/parameters.h"

namespace assay::direct_light {

std::vector<ParameterInformation> common_parameters() {
  return {luminaire::scene_parameter(), brdf_parameter()};
}

std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more) {
  return joined(joined(common_parameters(), {light_sampling_parameter()}), more);
}

Counts read_counts(Parameters& given) {
  return {.light = given.count("light_samples"), .brdf = given.count("brdf_samples")};
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
