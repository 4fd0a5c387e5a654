#include "estimators/picture_file.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"
#include "render/picture_kinds.h"

namespace assay {

namespace {

using namespace std::string_view_literals;

struct Kind {
  std::string_view magic;
  std::string_view ending;  ///< of the file's name, where a text may begin as the picture does
  std::unique_ptr<const PictureFile> (*open)(const std::string& file);
};

constexpr Kind kinds[] = {{"\x76\x2f\x31\x01"sv, "", render::open_exr},
                          {"PF\n"sv, ".pfm", render::open_pfm},
                          {"Pf\n"sv, ".pfm", render::open_pfm},
                          {"\x89PNG\r\n\x1a\n"sv, "", render::open_png}};

const Kind* kind_of(const std::string& file) {
  std::array<char, 8> begin{};
  std::ifstream(file, std::ios::binary).read(begin.data(), begin.size());
  const std::string_view bytes(begin.data(), begin.size());
  const auto* const found = std::ranges::find_if(kinds, [&](const Kind& kind) {
    return bytes.starts_with(kind.magic) && file.ends_with(kind.ending);
  });
  return found == std::end(kinds) ? nullptr : found;
}

/// Halves are multiples of 2^-24 at the finest, of 11 significant bits. Ties go to even.
float to_half(float value) {
  constexpr float largest = 65520;
  if (!(std::abs(value) < largest)) return value;
  return imath_half_to_float(imath_float_to_half(value));
}

float to_png(float value, double levels, bool alpha) {
  if (std::isnan(value)) return value;
  const double clipped = std::clamp(double{value}, 0., 1.);
  if (alpha) return static_cast<float>(std::round(clipped * levels) / levels);
  // The inverse of from_srgb.
  const double code =
      clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1 / 2.4) - 0.055;
  return static_cast<float>(render::from_srgb(std::round(code * levels) / levels));
}

}  // namespace

namespace render {

double from_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

void refuse_picture(const std::string& file, const std::string& why) {
  throw InputError({.file = file}, why);
}

void require_size(const std::string& file, std::size_t width, std::size_t height) {
  if (width == 0 || height == 0) refuse_picture(file, "the picture has no pixels");
  if (width <= most_pixels / height) return;
  refuse_picture(file, "the picture has " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels, more than 2^27; crop it or scale it down");
}

}  // namespace render

float rounded(float value, Rounding how, bool alpha) {
  switch (how) {
    case Rounding::half:
      return to_half(value);
    case Rounding::png16:
      return to_png(value, 65535, alpha);
    case Rounding::png8:
      return to_png(value, 255, alpha);
    case Rounding::none:
      break;
  }
  return value;
}

void PictureFile::refuse(const std::string& why) const { render::refuse_picture(name_, why); }

void PictureFile::require(bool holds, const std::string& why) const {
  if (!holds) refuse(why);
}

std::vector<std::string> PictureFile::channel_names() const {
  return mapped(channels_, &FileChannel::name);
}

bool PictureFile::has(const std::vector<std::string>& names) const {
  return std::ranges::all_of(names, [&](const std::string& name) {
    return std::ranges::count(channels_, name, &FileChannel::name) > 0;
  });
}

const FileChannel& PictureFile::channel(const std::string& name) const {
  const auto found = std::ranges::find(channels_, name, &FileChannel::name);
  if (found != channels_.end()) return *found;
  refuse("there is no channel `" + name + "`; it has " + quoted(channel_names()));
}

PictureWindow PictureFile::window(std::span<const std::string> names) const {
  const FileChannel& first = channel(names.front());
  for (const std::string& name : names) {
    require(channel(name).window == first.window,
            "the channels `" + first.name + "` and `" + name +
                "` are pictures of unequal sizes; choose channels of one size");
  }
  return first.window;
}

void PictureFile::read(std::span<const std::string> names, std::span<float> texels,
                       std::size_t first) const {
  const PictureWindow whole = window(names);
  const std::size_t row = whole.width * names.size();
  const std::size_t last = first + texels.size() / row;
  if (texels.size() % row != 0 || last > whole.height) {
    throw std::invalid_argument("PictureFile::read: there is room for " +
                                std::to_string(texels.size()) + " texels");
  }
  read_rows(names, texels, first, last);
}

std::unique_ptr<const PictureFile> open_picture(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    render::refuse_picture(file, "it is a folder, not a picture");
  }
  if (!std::ifstream(file)) {
    render::refuse_picture(file, std::string("it does not open: ") + std::strerror(errno));
  }
  const Kind* const kind = kind_of(file);
  if (kind == nullptr) {
    render::refuse_picture(file,
                           std::filesystem::is_empty(file, ignored)
                               ? "it is empty"
                               : "it is no OpenEXR, PFM or PNG picture; convert it to OpenEXR");
  }
  return kind->open(file);
}

bool is_picture(const std::string& file) { return kind_of(file) != nullptr; }

}  // namespace assay
