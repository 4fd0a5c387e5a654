#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace assay::reports {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Rgb&) const = default;
};

/// Row by row from the top.
struct Pixels {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Rgb> rows;
};

/// The picture as a PNG file of 8 bits a channel. The same bytes for the same pixels and version of
/// libpng and zlib. Throws std::runtime_error where libpng refuses (an empty picture).
std::vector<std::uint8_t> png(const Pixels& pixels);

}  // namespace assay::reports
