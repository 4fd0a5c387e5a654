#pragma once

// OpenEXR files of every kind that other programs write.

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>

#include "tests/estimators/exr.h"
#include "tests/prelude.h"

namespace assay::draws {

/// Texel (x, y) of channel c is 100 y + 10 x + c + 0.5, which a half holds exactly below 1024.
struct Part {
  int width = 4;
  int height = 3;
  std::vector<std::string> channels;
  Imf::PixelType type = Imf::FLOAT;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  std::string name = "";
  int samples = 0;  ///< the attribute samplesPerPixel, unless 0
  int left = 0;
};

inline float expected_texel(int x, int y, std::size_t channel) {
  return static_cast<float>(100 * y + 10 * x) + static_cast<float>(channel) + 0.5F;
}

/// A header and the texels behind its frame buffer.
struct Contents {
  Imf::Header header;
  std::vector<float> floats;
  std::vector<Imath::half> halves;
  Imf::FrameBuffer buffer;
};

inline Contents contents_of(const Part& part) {
  const Imath::Box2i box({part.left, 0}, {part.left + part.width - 1, part.height - 1});
  const Imath::Box2i canvas({0, 0}, {63, 63});  // one for all parts, as the format has it
  Contents contents{Imf::Header(canvas, box), {}, {}, {}};
  contents.header.compression() = part.compression;
  if (!part.name.empty()) contents.header.setName(part.name);
  if (part.samples != 0) {
    contents.header.insert("samplesPerPixel", Imf::IntAttribute(part.samples));
  }
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        contents.floats.push_back(expected_texel(x, y, c));
      }
    }
  }
  contents.halves.assign(contents.floats.begin(), contents.floats.end());
  insert_channels(
      part.channels, part.type, box, contents.header, contents.buffer,
      part.type == Imf::HALF ? static_cast<void*>(contents.halves.data()) : contents.floats.data());
  return contents;
}

inline void write_scan_lines(const std::string& file, const Part& part) {
  const Contents contents = contents_of(part);
  Imf::OutputFile output(file.c_str(), contents.header);
  output.setFrameBuffer(contents.buffer);
  output.writePixels(part.height);
}

inline void write_tiles(const std::string& file, const Part& part) {
  Contents contents = contents_of(part);
  contents.header.setTileDescription(Imf::TileDescription(2, 2, Imf::ONE_LEVEL));
  Imf::TiledOutputFile output(file.c_str(), contents.header);
  output.setFrameBuffer(contents.buffer);
  output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
}

inline void write_parts(const std::string& file, const std::vector<Part>& parts) {
  std::vector<Contents> contents;
  contents.reserve(parts.size());  // a frame buffer points into its texels
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    contents.push_back(contents_of(part));
    headers.push_back(contents.back().header);
    headers.back().setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart out(output, static_cast<int>(i));
    out.setFrameBuffer(contents[i].buffer);
    out.writePixels(parts[i].height);
  }
}

/// One sample in each of 2 x 2 pixels.
inline void write_deep(const std::string& file) {
  Imf::Header header(2, 2);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  unsigned counts[4] = {1, 1, 1, 1};
  float values[4] = {1, 2, 3, 4};
  float* pointers[4] = {values, values + 1, values + 2, values + 3};
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), 4, 8));
  buffer.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), sizeof(float*),
                                    2 * sizeof(float*), sizeof(float)));
  Imf::DeepScanLineOutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(2);
}

inline void write_bytes(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace assay::draws
