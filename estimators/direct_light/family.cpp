#include "direct_light/family.h"

#include <utility>

#include "estimators/parameters.h"

namespace assay::direct_light {

std::vector<ParameterInformation> common_parameters() {
  return joined(luminaire::information("", "", "").parameters, {brdf_parameter()});
}

std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more) {
  return joined(joined(common_parameters(), {light_sampling_parameter()}), more);
}

Parts read_parts(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  return {setting, read_reflectance(given), read_light_sampling(given, setting)};
}

SharedTechniques read_techniques(Parameters& given) {
  const Parts parts = read_parts(given);
  return std::make_shared<const Techniques>(parts.setting, parts.reflectance, parts.light_sampling);
}

std::vector<ParameterInformation> count_parameters() {
  return {count_parameter("light_samples", "samples of the light in a primary", "1", {1, 1000}),
          count_parameter("brdf_samples", "samples of the BRDF in a primary", "1", {1, 1000})};
}

Counts read_counts(Parameters& given) {
  const std::uint64_t light = given.count("light_samples");
  return {.light = light, .brdf = given.count("brdf_samples")};
}

ParameterInformation probability_parameter() {
  return {.name = "light_probability",
          .summary = "probability that the light is sampled, not the BRDF",
          .fallback = "0.5",
          .low = 0,
          .high = 1,
          .low_excluded = true,
          .high_excluded = true,
          .reason = "a technique that is never chosen leaves nothing to combine"};
}

Pair read_probabilities(Parameters& given) {
  const double light = given.number("light_probability");
  return {light, 1 - light};
}

Channel mean_channel(const Techniques& techniques) {
  Channel channel{.name = "radiance"};
  if (const auto known = radiance(techniques)) {
    channel.mean = known->value;
    channel.mean_error = known->error;
  }
  return channel;
}

Channel radiance_channel(const Techniques& techniques, const KnownPrimary& primary) {
  // Quadrature takes its time where a BRDF has kinks: not twice.
  const bool by_quadrature = primary.mean && !techniques.reflectance().constant();
  Channel channel = by_quadrature ? Channel{.name = "radiance",
                                            .mean = primary.mean->value,
                                            .mean_error = primary.mean->error}
                                  : mean_channel(techniques);
  channel.low = 0;
  channel.high = primary.high;
  const auto& variance = primary.variance;
  if (variance && variance->error <= 1e-8 * variance->value) channel.variance = variance->value;
  return channel;
}

double highest_of_brdf(const Techniques& techniques) {
  // A product and a quotient of a few factors, each rounded.
  return techniques.setting().radiance() * techniques.reflectance().weight_bound() * (1 + 0x1p-40);
}

}  // namespace assay::direct_light
