#pragma once

// The parts of the image of a plane's irradiance: a luminaire estimator at each of a grid of
// receivers.

#include "estimators/estimator.h"
#include "luminaire/area.h"

namespace assay::luminaire {

/// The grid: width x height receivers that share the scene's normal. They are the centres of equal
/// squares. The rectangle is centred on the scene's receiver and `size` long along the width.
struct Floor {
  ImageShape shape;
  std::vector<SharedSetting> settings;  ///< of each pixel, row by row
};

/// Reads scene, width, height, size, shared.
Floor read_floor(Parameters& parameters);

/// Channels with Lambert's mean, between 0 and the most that any point can bring.
std::vector<Channel> floor_channels(const Floor& floor);

}  // namespace assay::luminaire
