#include "sky/setting.h"

#include <array>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/parameters.h"
#include "luminaire/setting.h"

namespace assay::sky {

Receiver::Receiver(const render::Vector3& normal, const std::vector<render::Shape>& occluders)
    : frame_(render::Frame::about(normal)) {
  if (!occluders.empty()) scene_.emplace(occluders);
}

std::vector<ParameterInformation> with_receiver(ParameterInformation sky) {
  return {std::move(sky),
          structure_parameter("normal", "the receiver's normal, of any length", "[0, 0, 1]"),
          structure_parameter("position", "where the receiver is, for the occluders' sake",
                              "[0, 0, 0]"),
          structure_parameter("occluders",
                              "what hides the sky: a list as in the scenes of the luminaire family",
                              "[]")};
}

Receiver read_receiver(Parameters& given) {
  const luminaire::Receiver receiver{
      .position = luminaire::read_vector(given.structure("position"), "`position`"),
      .normal = luminaire::read_unit_vector(given.structure("normal"), "`normal`")};
  const auto occluders = luminaire::read_occluders(given.structure("occluders"), given.folder());
  return Receiver(receiver.normal, luminaire::occluder_shapes(occluders, receiver));
}

Rgb Setting::received(const Vector3& w, Cost& cost) const {
  return w.z <= 0 || !visible(w, cost) ? Rgb{} : w.z * radiance(w);
}

std::vector<ParameterInformation> parameters() { return with_receiver(sky_parameter()); }

SharedSetting read_setting(Parameters& given) {
  Receiver receiver = read_receiver(given);
  return std::make_shared<const Setting>(read_radiance(given), std::move(receiver));
}

std::vector<Channel> irradiance_channels(const Setting& setting, std::optional<double> gain) {
  constexpr std::array<const char*, 3> names = {"r", "g", "b"};
  return mapped_indices(setting.colours(), [&](std::size_t c) {
    Channel channel{.name = setting.colours() == 1 ? "irradiance" : names[c]};
    if (setting.open()) {
      const Known known = setting.radiance().irradiance(setting.frame().normal, c);
      channel.mean = known.value;
      channel.mean_error = known.error;
    }
    if (gain) {
      // A product of a few factors, each rounded.
      channel.low = 0;
      channel.high = *gain * setting.radiance().most(c) * (1 + 0x1p-40);
      channel.rounding = channel.high * 0x1p-40;
    }
    return channel;
  });
}

}  // namespace assay::sky
