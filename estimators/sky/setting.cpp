#include "sky/setting.h"

#include <array>
#include <utility>

#include "luminaire/setting.h"

namespace assay::sky {

Setting::Setting(SharedRadiance radiance, const Vector3& normal,
                 const std::vector<render::Shape>& occluders)
    : radiance_(std::move(radiance)), frame_(render::Frame::about(normal)) {
  if (!occluders.empty()) scene_.emplace(occluders);
}

Rgb Setting::received(const Vector3& w, Cost& cost) const {
  if (w.z <= 0 || !visible(w, cost)) return {};
  Rgb value = radiance(w);
  for (double& x : value) x *= w.z;
  return value;
}

std::vector<ParameterInformation> parameters() {
  return {sky_parameter(),
          {.name = "normal",
           .type = ParameterType::structure,
           .summary = "the receiver's normal, of any length",
           .fallback = "[0, 0, 1]"},
          {.name = "position",
           .type = ParameterType::structure,
           .summary = "where the receiver is, for the occluders' sake",
           .fallback = "[0, 0, 0]"},
          {.name = "occluders",
           .type = ParameterType::structure,
           .summary = "what hides the sky: a list as in the scenes of the luminaire family",
           .fallback = "[]"}};
}

SharedSetting read_setting(Parameters& given) {
  const luminaire::Receiver receiver{
      .position = luminaire::read_vector(given.structure("position"), "`position`"),
      .normal = luminaire::read_unit_vector(given.structure("normal"), "`normal`")};
  const auto occluders = luminaire::read_occluders(given.structure("occluders"), given.folder());
  return std::make_shared<const Setting>(read_radiance(given), receiver.normal,
                                         luminaire::occluder_shapes(occluders, receiver));
}

std::vector<Channel> irradiance_channels(const Setting& setting) {
  constexpr std::array<const char*, 3> names = {"r", "g", "b"};
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < setting.colours(); ++c) {
    Channel channel{.name = setting.colours() == 1 ? "irradiance" : names[c]};
    if (setting.open()) {
      const Known known = setting.radiance().irradiance(setting.frame().normal, c);
      channel.mean = known.value;
      channel.mean_error = known.error;
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

}  // namespace assay::sky
