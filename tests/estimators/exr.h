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

template <class Real>
void write_exr_as(const std::string& file, const Picture& picture, std::vector<Real> values) {
  const Imath::Box2i window({picture.left, picture.top},
                            {picture.left + picture.width - 1, picture.top + picture.height - 1});
  Imf::Header header(Imath::Box2i({0, 0}, window.max), window);
  header.compression() = picture.compression;
  const std::size_t texel = picture.channels.size() * sizeof(Real);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    header.channels().insert(picture.channels[c], Imf::Channel(picture.type));
    buffer.insert(picture.channels[c],
                  Imf::Slice::Make(picture.type, values.data() + c, window, texel,
                                   texel * static_cast<std::size_t>(picture.width)));
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(picture.height);
}

/// Writes 32-bit floats, losslessly compressed, or what `picture` says.
inline void write_exr(const std::string& file, const Picture& picture) {
  if (picture.type == Imf::HALF) {
    write_exr_as(file, picture,
                 std::vector<Imath::half>(picture.values.begin(), picture.values.end()));
  } else {
    write_exr_as(file, picture, picture.values);
  }
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
