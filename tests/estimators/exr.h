#pragma once

// Small OpenEXR pictures, written and read.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <string>
#include <vector>

namespace assay::draws {

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  std::vector<float> values;  ///< texel after texel, the channels of each in order
  Imf::PixelType type = Imf::FLOAT;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  int left = 0;  ///< where the data window begins on the canvas
  int top = 0;
};

/// Channels of a type whose texels stand one behind another, their values in order.
inline void insert_channels(const std::vector<std::string>& channels, Imf::PixelType type,
                            const Imath::Box2i& window, Imf::Header& header,
                            Imf::FrameBuffer& buffer, void* values) {
  const std::size_t size = type == Imf::HALF ? 2 : 4;
  const std::size_t texel = channels.size() * size;
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels[c], Imf::Channel(type));
    buffer.insert(channels[c], Imf::Slice::Make(type, static_cast<char*>(values) + c * size, window,
                                                texel, texel * width));
  }
}

/// Writes 32-bit floats, losslessly compressed, or what `picture` says.
inline void write_exr(const std::string& file, const Picture& picture) {
  const Imath::Box2i window({picture.left, picture.top},
                            {picture.left + picture.width - 1, picture.top + picture.height - 1});
  Imf::Header header(Imath::Box2i({0, 0}, window.max), window);
  header.compression() = picture.compression;
  std::vector<float> floats = picture.values;
  std::vector<Imath::half> halves(floats.begin(), floats.end());
  Imf::FrameBuffer buffer;
  insert_channels(picture.channels, picture.type, window, header, buffer,
                  picture.type == Imf::HALF ? static_cast<void*>(halves.data()) : floats.data());
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(picture.height);
}

/// One channel, row after row.
inline std::vector<float> read_exr_channel(const std::string& file, const std::string& channel) {
  Imf::InputFile input(file.c_str());
  const Imath::Box2i window = input.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  std::vector<float> values(width * static_cast<std::size_t>(window.max.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float),
                                          sizeof(float) * width));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return values;
}

}  // namespace assay::draws
