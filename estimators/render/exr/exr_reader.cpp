#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cmath>
#include <exception>
#include <sstream>

#include "estimators/core/value.h"
#include "render/environment_map.h"
#include "render/picture_kinds.h"

namespace assay::render {

namespace {

// The channels to read as red, green and blue; grey stands for all three.
std::array<std::string, 3> channel_names(const Imf::ChannelList& channels,
                                         const std::string& file) {
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  if (has("R") && has("G") && has("B")) return {"R", "G", "B"};
  if (has("Y")) return {"Y", "Y", "Y"};
  std::string found;
  for (auto i = channels.begin(); i != channels.end(); ++i) {
    found += std::string(found.empty() ? "" : ", ") + i.name();
  }
  refuse_picture(file, "the picture needs the channels R, G and B, or Y; it has " +
                           (found.empty() ? "none" : found));
}

Resolution resolution(const Imf::Header& header, const std::string& file) {
  const Imath::Box2i window = header.dataWindow();
  if (window != header.displayWindow()) {
    refuse_picture(file, "the picture is cropped: its data window must be its display window");
  }
  const auto width = std::int64_t{window.max.x} - window.min.x + 1;
  const auto height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0) refuse_picture(file, "the picture has no texels");
  const Resolution size{static_cast<std::size_t>(width), static_cast<std::size_t>(height)};
  if (size.width > most_pixels / size.height) {
    refuse_picture(file, "the picture has more than 2^27 texels; scale it down");
  }
  return size;
}

std::vector<float> read_channel(Imf::InputFile& input, const std::string& name,
                                const std::string& file) {
  const Imf::Channel& channel = input.header().channels()[name.c_str()];
  if (channel.xSampling != 1 || channel.ySampling != 1) {
    refuse_picture(file, "channel " + name + " is sub-sampled; store it at full resolution");
  }
  const Resolution size = resolution(input.header(), file);
  std::vector<float> texels(size.width * size.height);
  const Imath::Box2i window = input.header().dataWindow();
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, texels.data(), window));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return texels;
}

void check(const std::vector<Rgb>& texels, std::size_t width, const std::string& file) {
  for (std::size_t i = 0; i < texels.size(); ++i) {
    for (const double value : texels[i]) {
      if (std::isfinite(value) && value >= 0) continue;
      std::ostringstream why;
      why << "the texel in row " << i / width << ", column " << i % width << " is " << value
          << "; radiance must be finite and not negative";
      refuse_picture(file, why.str());
    }
  }
}

EnvironmentMap read(const std::string& file) {
  require_sound_headers(file);
  Imf::InputFile input(file.c_str());
  const Resolution size = resolution(input.header(), file);
  const std::array<std::string, 3> names = channel_names(input.header().channels(), file);
  std::vector<Rgb> texels(size.width * size.height);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> channel = read_channel(input, names[c], file);
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i][c] = double{channel[i]};
  }
  check(texels, size.width, file);
  return {size, std::move(texels)};
}

}  // namespace

EnvironmentMap read_environment(const std::string& file) {
  try {
    return read(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    refuse_picture(file, std::string("the picture cannot be read as OpenEXR: ") + error.what());
  }
}

}  // namespace assay::render
