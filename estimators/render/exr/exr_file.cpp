#include "estimators/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfTestFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>

#include "estimators/core/value.h"
#include "render/exr/exr_header.h"

namespace assay {

namespace {

constexpr std::size_t most_pixels = std::size_t{1} << 27;
// A black picture of PIZ compresses to a few thousandths of a per cent; no scheme comes near this.
constexpr double most_compression = 0x1p16;

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError({.file = file}, why);
}

ExrWindow window_of(const Imf::Header& header) {
  const Imath::Box2i& box = header.dataWindow();
  const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1;
  const std::int64_t height = std::int64_t{box.max.y} - box.min.y + 1;
  return {.left = box.min.x,
          .top = box.min.y,
          .width = static_cast<std::size_t>(std::max<std::int64_t>(width, 0)),
          .height = static_cast<std::size_t>(std::max<std::int64_t>(height, 0))};
}

/// Refuses a header whose pictures cannot fit into a file of this many bytes: it could ask for any
/// amount of memory.
void require_possible(const Imf::Header& header, const std::string& file, double bytes) {
  const ExrWindow window = window_of(header);
  const std::string size = std::to_string(window.width) + " x " + std::to_string(window.height);
  if (window.width == 0 || window.height == 0) refuse(file, "the picture has no pixels");
  if (window.width > most_pixels / window.height) {
    refuse(file, "the picture has " + size + " pixels, more than 2^27; crop it or scale it down");
  }
  double pixel = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    pixel += i.channel().type == Imf::HALF ? 2 : 4;
  }
  const double pixels = static_cast<double>(window.width) * static_cast<double>(window.height);
  if (pixels * pixel > bytes * most_compression) {
    refuse(file, "its header promises " + size +
                     " pixels, which a file of this size cannot hold: it is damaged; write it "
                     "again");
  }
}

/// Tiles are kept whole in memory while they are read.
void require_possible_tiles(const Imf::Header& header, const std::string& file) {
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tile = header.tileDescription();
  const ExrWindow window = window_of(header);
  const auto beyond = [](unsigned tiled, std::size_t whole) {
    return tiled == 0 || tiled > std::max<std::size_t>(16384, 2 * whole);
  };
  if (beyond(tile.xSize, window.width) || beyond(tile.ySize, window.height)) {
    refuse(file, "its tiles are larger than the picture: it is damaged; write it again");
  }
}

std::string full_name(const Imf::Header& header, int parts, const std::string& channel) {
  if (parts == 1 || !header.hasName()) return channel;
  const std::string prefix = header.name() + ".";
  return channel.starts_with(prefix) ? channel : prefix + channel;
}

std::string listed(const std::vector<ExrChannel>& channels) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, channels.size()); ++i) {
    text += (i == 0 ? "`" : ", `") + channels[i].name + "`";
  }
  if (channels.size() > most) text += ", … (" + std::to_string(channels.size()) + " in all)";
  return text.empty() ? "none" : text;
}

}  // namespace

struct ExrFile::Parts {
  std::string name;
  std::unique_ptr<Imf::MultiPartInputFile> input;
  std::vector<ExrChannel> channels;
  std::optional<std::uint64_t> samples;

  const ExrChannel& find(const std::string& wanted) const {
    const auto found = std::ranges::find(channels, wanted, &ExrChannel::name);
    if (found != channels.end()) return *found;
    refuse(name, "there is no channel `" + wanted + "`; it has " + listed(channels));
  }

  void open();
  void add_part(int part, double bytes);
  void require_whole(const ExrChannel& channel) const;
};

void ExrFile::Parts::open() {
  const auto bytes = static_cast<double>(std::filesystem::file_size(name));
  input = std::make_unique<Imf::MultiPartInputFile>(name.c_str(), 0);
  for (int part = 0; part < input->parts(); ++part) add_part(part, bytes);
}

void ExrFile::Parts::add_part(int part, double bytes) {
  const Imf::Header& header = input->header(part);
  if (header.hasType() && !Imf::isImage(header.type())) {
    refuse(name, "it holds deep pixels, with several samples each; flatten it first");
  }
  require_possible(header, name, bytes);
  require_possible_tiles(header, name);
  if (!input->partComplete(part)) {
    refuse(name, "the picture is not complete: writing it was interrupted; write it again");
  }
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    channels.push_back({.name = full_name(header, input->parts(), i.name()),
                        .window = window_of(header),
                        .part = part,
                        .in_part = i.name()});
  }
  const auto* const count = header.findTypedAttribute<Imf::IntAttribute>("samplesPerPixel");
  if (count != nullptr && count->value() > 0 && !samples) {
    samples = static_cast<std::uint64_t>(count->value());
  }
}

void ExrFile::Parts::require_whole(const ExrChannel& channel) const {
  const Imf::Channel& described = input->header(channel.part).channels()[channel.in_part.c_str()];
  if (described.xSampling == 1 && described.ySampling == 1) return;
  refuse(name, "channel `" + channel.in_part + "` is sub-sampled; store it at full resolution");
}

namespace {

/// Turns an exception of the library into our own error.
template <class Work>
auto in_our_words(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    // The library's messages begin with the file's name, which ours do too.
    std::string why = error.what();
    for (const char* const prefix :
         {"Cannot read image file", "Error reading pixel data from image file"}) {
      const std::string quoted = std::string(prefix) + " \"" + file + "\". ";
      if (why.starts_with(quoted)) why.erase(0, quoted.size());
    }
    refuse(file, "it cannot be read as OpenEXR, damaged or cut short: " + why);
  }
}

}  // namespace

ExrFile::ExrFile(const std::string& file) : parts_(std::make_unique<Parts>()) {
  parts_->name = file;
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) refuse(file, "it is a folder, not a picture");
  if (!std::ifstream(file)) refuse(file, std::string("it does not open: ") + std::strerror(errno));
  if (!is_exr(file)) refuse(file, "it is no OpenEXR picture; convert it to OpenEXR");
  render::require_sound_headers(file);
  in_our_words(file, [&] { parts_->open(); });
}

ExrFile::~ExrFile() = default;

const std::string& ExrFile::name() const { return parts_->name; }
const std::vector<ExrChannel>& ExrFile::channels() const { return parts_->channels; }
std::optional<std::uint64_t> ExrFile::samples_per_pixel() const { return parts_->samples; }

ExrWindow ExrFile::window(std::span<const std::string> names) const {
  const ExrChannel& first = parts_->find(names.front());
  for (const std::string& name : names) {
    if (parts_->find(name).window == first.window) continue;
    refuse(parts_->name, "the channels `" + first.name + "` and `" + name +
                             "` are pictures of unequal sizes; choose channels of one size");
  }
  return first.window;
}

void ExrFile::read(std::span<const std::string> names, std::span<float> texels,
                   std::size_t first) const {
  const ExrWindow whole = window(names);
  const std::size_t row = whole.width * names.size();
  const std::size_t last = first + texels.size() / row;
  if (texels.size() % row != 0 || last > whole.height) {
    throw std::invalid_argument("ExrFile::read: there is room for " +
                                std::to_string(texels.size()) + " texels");
  }
  const auto row_at = [&](std::size_t y) {
    return static_cast<int>(whole.top) + static_cast<int>(y);
  };
  const auto left = static_cast<int>(whole.left);
  const Imath::Box2i box({left, row_at(first)},
                         {left + static_cast<int>(whole.width) - 1, row_at(last) - 1});
  const std::size_t texel = names.size() * sizeof(float);
  std::map<int, Imf::FrameBuffer> buffers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ExrChannel& channel = parts_->find(names[i]);
    parts_->require_whole(channel);
    buffers[channel.part].insert(
        channel.in_part,
        Imf::Slice::Make(Imf::FLOAT, texels.data() + i, box, texel, row * sizeof(float)));
  }
  in_our_words(parts_->name, [&] {
    for (const auto& [part, buffer] : buffers) {
      Imf::InputPart input(*parts_->input, part);
      input.setFrameBuffer(buffer);
      input.readPixels(box.min.y, box.max.y);
    }
  });
}

bool is_exr(const std::string& file) { return Imf::isOpenExrFile(file.c_str()); }

}  // namespace assay
