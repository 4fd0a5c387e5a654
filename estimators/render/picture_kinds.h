#pragma once

// The kinds of pictures that open_picture() chooses from.

#include <cstddef>
#include <memory>
#include <string>

#include "estimators/picture_file.h"

namespace assay::render {

constexpr std::size_t most_pixels = std::size_t{1} << 27;

[[noreturn]] void refuse_picture(const std::string& file, const std::string& why);
/// Refuses a picture without pixels or with more than `most_pixels`.
void require_size(const std::string& file, std::size_t width, std::size_t height);

/// sRGB's curve, from code to linear light, both in [0, 1] (IEC 61966-2-1).
double from_srgb(double code);

std::unique_ptr<const PictureFile> open_exr(const std::string& file);
std::unique_ptr<const PictureFile> open_pfm(const std::string& file);
std::unique_ptr<const PictureFile> open_png(const std::string& file);

}  // namespace assay::render
