#pragma once

// Plans of depth of field's images from parameters as text.

#include <string>

#include "depth_of_field/image.h"
#include "depth_of_field/reconstruction.h"
#include "estimators/core/flow.h"

namespace assay::tests {

inline depth_of_field::ImagePlan image_plan(const std::string& parameters) {
  Parameters given("depth_of_field/image", depth_of_field::image_information().parameters,
                   parse_flow(parameters), "");
  return depth_of_field::read_image_plan(given);
}

inline depth_of_field::ReconstructionPlan reconstruction_plan(
    const std::string& parameters, const depth_of_field::ReconstructionRules& rules = {}) {
  Parameters given("depth_of_field/reconstruction",
                   depth_of_field::reconstruction_information().parameters, parse_flow(parameters),
                   "");
  return depth_of_field::read_reconstruction_plan(given, rules);
}

}  // namespace assay::tests
