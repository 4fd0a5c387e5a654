#pragma once

// Numbers for every pixel as an OpenEXR picture, for programs that show such.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace assay {

struct MapSize {
  std::size_t width = 0;
  std::size_t height = 0;
};

/// A layer: its value of column x, row y and component c is values[(y * width + x) * components +
/// c]. In the file its channels are called `name.component`.
struct MapLayer {
  std::string name;
  std::vector<std::string> components;
  std::span<const float> values;
};

/// Writes layers of one size as 32-bit floats, losslessly compressed, rows from the top; whole or
/// not at all. Throws std::runtime_error naming the file.
void write_map_file(const std::string& file, const MapSize& size,
                    const std::vector<MapLayer>& layers);

}  // namespace assay
