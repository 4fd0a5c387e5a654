#include "estimators/image.h"

namespace assay {

std::string element_name(const ImageShape& shape, std::size_t element) {
  const std::size_t components = shape.components.size();
  const std::size_t pixel = element / components;
  std::string name =
      "x" + std::to_string(pixel % shape.width) + "y" + std::to_string(pixel / shape.width);
  if (components > 1) name += "." + shape.components[element % components];
  return name;
}

}  // namespace assay
