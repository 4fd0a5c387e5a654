#include "sky/receiver.h"

#include <utility>

#include "luminaire/setting.h"

namespace assay::sky {

Receiver::Receiver(const render::Vector3& normal, const std::vector<render::Shape>& occluders)
    : frame_(render::Frame::about(normal)) {
  if (!occluders.empty()) scene_.emplace(occluders);
}

std::vector<ParameterInformation> with_receiver(ParameterInformation sky) {
  return {std::move(sky),
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

Receiver read_receiver(Parameters& given) {
  const luminaire::Receiver receiver{
      .position = luminaire::read_vector(given.structure("position"), "`position`"),
      .normal = luminaire::read_unit_vector(given.structure("normal"), "`normal`")};
  const auto occluders = luminaire::read_occluders(given.structure("occluders"), given.folder());
  return Receiver(receiver.normal, luminaire::occluder_shapes(occluders, receiver));
}

}  // namespace assay::sky
