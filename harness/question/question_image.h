#pragma once

#include <string>

#include "harness/question/question.h"

namespace assay::harness {

bool has_image(const Question& question);

/// Turns a question on the means of images into one on all elements together. Costs and total
/// variances stay as they are. InputError if there is no method: for inequalities, other
/// quantities, images of unequal sizes, and an image against a non-image. InputError also for a
/// number with an error, and for a relative margin of a zero image.
void ask_of_images(Question& question);

/// "32 x 32 irradiance".
std::string image_name(const ImageShape& shape);

}  // namespace assay::harness
