#include "reports/formats/png.h"

#include <png.h>

#include <stdexcept>
#include <string>

namespace assay::reports {

std::vector<std::uint8_t> png(const Pixels& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width);
  image.height = static_cast<png_uint_32>(pixels.height);
  image.format = PNG_FORMAT_RGB;
  const auto refused = [&] { return std::runtime_error(std::string("libpng: ") + image.message); };
  png_alloc_size_t size = 0;
  static_assert(sizeof(Rgb) == 3, "libpng reads the three bytes of a pixel in a row");
  if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels.rows.data(), 0, nullptr) == 0) {
    throw refused();
  }
  std::vector<std::uint8_t> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.rows.data(), 0, nullptr) ==
      0) {
    throw refused();
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace assay::reports
