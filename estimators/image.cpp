#include "estimators/image.h"

#include "estimators/estimator.h"

namespace assay {

std::string element_name(const ImageShape& shape, std::size_t element) {
  const std::size_t components = shape.components.size();
  const std::size_t pixel = element / components;
  std::string name =
      "x" + std::to_string(shape.left + static_cast<std::int64_t>(pixel % shape.width)) + "y" +
      std::to_string(shape.top + static_cast<std::int64_t>(pixel / shape.width));
  if (components > 1) name += "." + shape.components[element % components];
  return name;
}

std::vector<Channel> element_channels(const ImageShape& shape, const Channel& element) {
  std::vector<Channel> channels(shape.elements(), element);
  for (std::size_t e = 0; e < channels.size(); ++e) channels[e].name = element_name(shape, e);
  return channels;
}

}  // namespace assay
