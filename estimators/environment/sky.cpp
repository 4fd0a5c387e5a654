#include "environment/sky.h"

#include <string>
#include <utility>

namespace assay::environment {

std::vector<ParameterInformation> parameters() {
  return sky::with_receiver(
      {.name = "map",
       .type = ParameterType::string,
       .summary = "the sky: an OpenEXR picture, latitude-longitude, +z the first row's pole"});
}

namespace {

render::EnvironmentMap read_map(Parameters& parameters) {
  const std::string file = parameters.file("map");
  try {
    return render::read_environment(file);
  } catch (const InputError& error) {
    parameters.refuse("map", "`" + file + "`: " + error.message());
  }
}

}  // namespace

SharedSky read_sky(Parameters& parameters) {
  sky::Receiver receiver = sky::read_receiver(parameters);
  return std::make_shared<const Sky>(read_map(parameters), std::move(receiver));
}

std::vector<Channel> irradiance_channels(const Sky& sky, const Primaries& primaries) {
  const render::EnvironmentMap& map = sky.map();
  Rgb mean{}, error{}, square{};
  for (std::size_t texel = 0; sky.open() && texel < map.size(); ++texel) {
    const auto moments = cosine_moments(map.patch(texel), sky.frame().normal);
    const double second = primaries.second_moment(texel, moments);
    for (std::size_t c = 0; c < 3; ++c) {
      const double radiance = map.radiance(texel)[c];
      mean[c] += radiance * moments.first;
      error[c] += radiance * moments.error;
      square[c] += radiance * radiance * second;
    }
  }
  std::vector<Channel> channels{{.name = "r"}, {.name = "g"}, {.name = "b"}};
  // The rounding of a sum of n terms that are not negative is at most n 2^-53 of it.
  const double rounding = static_cast<double>(map.size()) * 0x1p-53;
  for (std::size_t c = 0; c < 3; ++c) {
    // A uniform sky gives equal numbers to the cosine sampler, but for the rounding of their sums.
    channels[c].rounding = primaries.largest[c] * 0x1p-40;
    channels[c].low = 0;
    channels[c].high = primaries.largest[c] + channels[c].rounding;
    if (!sky.open()) continue;
    channels[c].mean = mean[c];
    channels[c].mean_error = error[c] + rounding * mean[c];
    // A variance with fewer than some eight digits left by the difference counts as unknown.
    const double variance = square[c] - mean[c] * mean[c];
    if (variance > 1e-6 * square[c] || square[c] == 0) channels[c].variance = variance;
  }
  return channels;
}

}  // namespace assay::environment
