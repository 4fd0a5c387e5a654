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
};

/// Writes 32-bit floats, losslessly compressed.
inline void write_exr(const std::string& file, const Picture& picture) {
  Imf::Header header(picture.width, picture.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  const std::size_t texel = picture.channels.size() * sizeof(float);
  std::vector<float> values = picture.values;
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    header.channels().insert(picture.channels[c], Imf::Channel(Imf::FLOAT));
    buffer.insert(picture.channels[c],
                  Imf::Slice::Make(Imf::FLOAT, values.data() + c, header.dataWindow(), texel,
                                   texel * static_cast<std::size_t>(picture.width)));
  }
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
