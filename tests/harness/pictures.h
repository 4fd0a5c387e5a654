#pragma once

// Stacks of pictures as renderers write them.

#include <fmt/format.h>

#include "tests/estimators/exr.h"
#include "tests/harness/running.h"
#include "tests/philox.h"

namespace assay::harness {

using Texel = std::function<float(int x, int y, const std::string& channel, double noise)>;

struct PictureKind {
  int width = 6;
  int height = 5;
  std::vector<std::string> channels = {"R", "G", "B"};
  Imf::PixelType type = Imf::FLOAT;
  int left = 0;
  int top = 0;
  int right = width;
  int bottom = height;
  std::uint32_t seed = 0;  ///< of the noise; by default the name's
  int count = 24;
};

inline draws::Picture picture_of(const PictureKind& kind, const Texel& texel,
                                 tests::Philox& random) {
  draws::Picture picture{.width = kind.right - kind.left,
                         .height = kind.bottom - kind.top,
                         .channels = kind.channels,
                         .values = {},
                         .type = kind.type,
                         .left = kind.left,
                         .top = kind.top};
  for (int y = 0; y < kind.height; ++y) {
    for (int x = 0; x < kind.width; ++x) {
      for (const std::string& channel : kind.channels) {
        const float value = texel(x, y, channel, random.normal());
        const bool inside = x >= kind.left && x < kind.right && y >= kind.top && y < kind.bottom;
        if (inside) picture.values.push_back(value);
      }
    }
  }
  return picture;
}

using WritePicture = std::function<void(const std::string& file, const draws::Picture&)>;

/// Pictures NAME00, NAME01, … with the ending.
inline void write_stack(const Workplace& place, const std::string& name, const PictureKind& kind,
                        const Texel& texel, const std::string& ending = "exr",
                        const WritePicture& write = draws::write_exr) {
  tests::Philox random(kind.seed != 0 ? kind.seed : static_cast<std::uint32_t>(name[0]));
  for (int i = 0; i < kind.count; ++i) {
    write(place.file(fmt::format("{}{:02}.{}", name, i, ending)), picture_of(kind, texel, random));
  }
}

/// Stacks `a` and `b` of one law.
inline void write_pair(const Workplace& place, const PictureKind& kind, const Texel& texel) {
  for (const char* name : {"a", "b"}) write_stack(place, name, kind, texel);
}

/// The same value everywhere.
inline Texel flat(float value) {
  return [value](int, int, const std::string&, double) { return value; };
}

}  // namespace assay::harness
