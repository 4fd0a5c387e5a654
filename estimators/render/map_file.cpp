#include "estimators/map_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

namespace assay {

namespace {

void write(const std::string& file, const MapSize& size, const std::vector<MapLayer>& layers) {
  const auto width = static_cast<int>(size.width);
  const auto height = static_cast<int>(size.height);
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (const MapLayer& layer : layers) {
    const std::size_t texel = layer.components.size() * sizeof(float);
    if (layer.values.size() != size.width * size.height * layer.components.size()) {
      throw std::invalid_argument("layer " + layer.name + " has another size");
    }
    for (std::size_t c = 0; c < layer.components.size(); ++c) {
      const std::string channel = layer.name + "." + layer.components[c];
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      // The library's slices are not const; writing leaves the values alone.
      auto* first = const_cast<float*>(layer.values.data() + c);
      buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, first, header.dataWindow(), texel,
                                              texel * size.width));
    }
  }
  // One thread: the file is then the same whatever else runs.
  Imf::OutputFile output(file.c_str(), header, 0);
  output.setFrameBuffer(buffer);
  output.writePixels(height);
}

}  // namespace

void write_map_file(const std::string& file, const MapSize& size,
                    const std::vector<MapLayer>& layers) {
  const std::string unfinished = file + ".tmp";
  try {
    write(unfinished, size, layers);
    std::filesystem::rename(unfinished, file);
  } catch (const std::exception& error) {
    std::remove(unfinished.c_str());
    throw std::runtime_error("cannot write " + file + ": " + error.what());
  }
}

}  // namespace assay
