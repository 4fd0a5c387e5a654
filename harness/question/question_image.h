#pragma once

// What may be claimed of images.

#include <string>

#include "harness/question/question.h"

namespace assay::harness {

/// Whether a side of the question is an image.
bool has_image(const Question& question);

/// Makes a question on the means of images one on all their elements together; those on costs and
/// total variances stay as they are. InputError where there is no method: an inequality, another
/// quantity, images of unequal sizes, an image and something that is none, a number with an error
/// of its own, a margin in per cent of an image that is zero.
void ask_of_images(Question& question);

/// "32 x 32 irradiance".
std::string image_name(const ImageShape& shape);

}  // namespace assay::harness
