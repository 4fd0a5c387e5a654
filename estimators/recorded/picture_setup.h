#pragma once

// Pictures of another program as a set-up.

#include <memory>
#include <string>

#include "estimators/estimator.h"
#include "estimators/pictures.h"
#include "estimators/ready_made.h"

namespace assay::recorded {

/// Observation i is file i. Files are read one by one when they are asked for and not kept.
/// `data_file` tells which files they are (Setup::data_file()).
std::shared_ptr<const Setup> picture_setup(PictureStack stack, bool independent,
                                           std::string data_file);

/// Means with their errors; there is nothing to draw.
std::shared_ptr<const Setup> reference_setup(PictureMoments moments);

/// The channel that follows the elements in an observation: their average, for claims that name it.
Channel average_channel();

/// A picture's texels and their average.
void write_observation(std::span<const float> texels, std::span<double> out);

}  // namespace assay::recorded
