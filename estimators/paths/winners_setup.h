#pragma once

// The common parts of go with the winners and its mutants.

#include "paths/family.h"
#include "paths/winners.h"

namespace assay::paths {

inline std::vector<ParameterInformation> winners_parameters() {
  return {scene_parameter("sphere"),
          direct_parameter(),
          {.name = "splitting",
           .summary = "N, children of a diffuse vertex of weight and albedo 1",
           .fallback = "4",
           .low = 1,
           .high = 1000}};
}

}  // namespace assay::paths
