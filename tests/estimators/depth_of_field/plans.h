#pragma once

// Plans of depth of field's images from parameters as text.

#include "depth_of_field/image.h"
#include "depth_of_field/reconstruction.h"
#include "estimators/catalogue.h"
#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::tests {

inline Parameters parameters_of(const std::string& plugin, const std::string& parameters) {
  return {plugin, find_plugin(plugin, {}).information.parameters, parse_flow(parameters), ""};
}

inline depth_of_field::ImagePlan image_plan(const std::string& parameters) {
  Parameters given = parameters_of("depth_of_field/image", parameters);
  return depth_of_field::read_image_plan(given);
}

inline depth_of_field::ReconstructionPlan reconstruction_plan(
    const std::string& parameters, const depth_of_field::ReconstructionRules& rules = {}) {
  Parameters given = parameters_of("depth_of_field/reconstruction", parameters);
  return depth_of_field::read_reconstruction_plan(given, rules);
}

}  // namespace assay::tests
