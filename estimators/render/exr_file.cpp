#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>

#include "estimators/core/value.h"
#include "render/picture_kinds.h"

namespace assay::render {

namespace {

// Keeps the first message, that of the cause.
void keep_message(exr_const_context_t context, exr_result_t, const char* message) {
  void* first = nullptr;
  if (exr_get_user_data(context, &first) != EXR_ERR_SUCCESS || first == nullptr) return;
  std::string& kept = *static_cast<std::string*>(first);
  if (kept.empty()) kept = message;
}

// A black picture of PIZ compresses to a few thousandths of a per cent; no scheme comes near this.
constexpr double most_compression = 0x1p16;

PictureWindow window_of(const Imath::Box2i& box, const Imath::Box2i& canvas) {
  const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1;
  const std::int64_t height = std::int64_t{box.max.y} - box.min.y + 1;
  return {.left = std::int64_t{box.min.x} - canvas.min.x,
          .top = std::int64_t{box.min.y} - canvas.min.y,
          .width = static_cast<std::size_t>(std::max<std::int64_t>(width, 0)),
          .height = static_cast<std::size_t>(std::max<std::int64_t>(height, 0))};
}

PictureWindow window_of(const Imf::Header& header) {
  return window_of(header.dataWindow(), header.displayWindow());
}

/// Refuses a header whose pictures cannot fit into a file of this many bytes: it could ask for any
/// amount of memory.
void require_possible(const Imf::Header& header, const std::string& file, double bytes) {
  const PictureWindow window = window_of(header);
  require_size(file, window.width, window.height);
  double pixel = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    pixel += i.channel().type == Imf::HALF ? 2 : 4;
  }
  const double pixels = static_cast<double>(window.width) * static_cast<double>(window.height);
  if (pixels * pixel > bytes * most_compression) {
    refuse_picture(file, "its header promises " + std::to_string(window.width) + " x " +
                             std::to_string(window.height) +
                             " pixels, which a file of this size cannot hold: it is damaged; "
                             "write it again");
  }
}

/// Tiles are kept whole in memory while they are read.
void require_possible_tiles(const Imf::Header& header, const std::string& file) {
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tile = header.tileDescription();
  const PictureWindow window = window_of(header);
  const auto beyond = [](unsigned tiled, std::size_t whole) {
    return tiled == 0 || tiled > std::max<std::size_t>(16384, 2 * whole);
  };
  if (beyond(tile.xSize, window.width) || beyond(tile.ySize, window.height)) {
    refuse_picture(file, "its tiles are larger than the picture: it is damaged; write it again");
  }
}

std::string full_name(const Imf::Header& header, int parts, const std::string& channel) {
  if (parts == 1 || !header.hasName()) return channel;
  const std::string prefix = header.name() + ".";
  return channel.starts_with(prefix) ? channel : prefix + channel;
}

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
    refuse_picture(file, "it cannot be read as OpenEXR, damaged or cut short: " + why);
  }
}

/// InputError at the file if OpenEXR's core finds a fault in the headers. The core holds every
/// attribute against the file's size. The library's classes would allocate the size that an
/// attribute states before they read it.
void require_sound_headers(const std::string& file) {
  std::string trouble;
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.user_data = &trouble;
  settings.error_handler_fn = keep_message;
  exr_context_t context = nullptr;
  const exr_result_t result = exr_start_read(&context, file.c_str(), &settings);
  if (result == EXR_ERR_SUCCESS) exr_finish(&context);
  if (trouble.empty() && result == EXR_ERR_SUCCESS) return;
  if (trouble.empty()) trouble = exr_get_default_error_message(result);
  throw InputError({.file = file},
                   "it cannot be read as OpenEXR, damaged or cut short: " + trouble);
}

class ExrFile final : public PictureFile {
 public:
  explicit ExrFile(const std::string& file) : PictureFile(file) {
    require_sound_headers(file);
    in_our_words(file, [&] { open(); });
  }

 private:
  void open();
  void add_part(int part, double bytes);
  void require_whole(const FileChannel& channel) const;
  void read_rows(std::span<const std::string> names, std::span<float> texels, std::size_t first,
                 std::size_t last) const override;

  std::unique_ptr<Imf::MultiPartInputFile> input_;
};

void ExrFile::open() {
  const auto bytes = static_cast<double>(std::filesystem::file_size(name_));
  input_ = std::make_unique<Imf::MultiPartInputFile>(name_.c_str(), 0);
  for (int part = 0; part < input_->parts(); ++part) add_part(part, bytes);
  const Imath::Box2i canvas = input_->header(0).displayWindow();
  canvas_ = window_of(canvas, canvas);
}

void ExrFile::add_part(int part, double bytes) {
  const Imf::Header& header = input_->header(part);
  require(!header.hasType() || Imf::isImage(header.type()),
          "it holds deep pixels, with several samples each; flatten it first");
  require_possible(header, name_, bytes);
  require_possible_tiles(header, name_);
  require(input_->partComplete(part),
          "the picture is not complete: writing it was interrupted; write it again");
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    channels_.push_back(
        {.name = full_name(header, input_->parts(), i.name()),
         .window = window_of(header),
         .rounding = i.channel().type == Imf::HALF ? Rounding::half : Rounding::none,
         .part = part,
         .in_part = i.name()});
  }
  const auto* const count = header.findTypedAttribute<Imf::IntAttribute>("samplesPerPixel");
  if (count != nullptr && count->value() > 0 && !samples_) {
    samples_ = static_cast<std::uint64_t>(count->value());
  }
}

void ExrFile::require_whole(const FileChannel& channel) const {
  const Imf::Channel& described = input_->header(channel.part).channels()[channel.in_part.c_str()];
  require(described.xSampling == 1 && described.ySampling == 1,
          "channel `" + channel.in_part + "` is sub-sampled; store it at full resolution");
}

void ExrFile::read_rows(std::span<const std::string> names, std::span<float> texels,
                        std::size_t first, std::size_t last) const {
  const Imath::Box2i& whole = input_->header(channel(names.front()).part).dataWindow();
  const Imath::Box2i box({whole.min.x, whole.min.y + static_cast<int>(first)},
                         {whole.max.x, whole.min.y + static_cast<int>(last) - 1});
  const bool halves = std::ranges::all_of(
      names, [&](const std::string& name) { return channel(name).rounding == Rounding::half; });
  const std::size_t size = halves ? sizeof(std::uint16_t) : sizeof(float);
  char* const out = reinterpret_cast<char*>(texels.data());
  const std::size_t texel = names.size() * size;
  const std::size_t row = window(names).width * texel;
  std::map<int, Imf::FrameBuffer> buffers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const FileChannel& from = channel(names[i]);
    require_whole(from);
    buffers[from.part].insert(from.in_part, Imf::Slice::Make(halves ? Imf::HALF : Imf::FLOAT,
                                                             out + i * size, box, texel, row));
  }
  in_our_words(name_, [&] {
    for (const auto& [part, buffer] : buffers) {
      Imf::InputPart input(*input_, part);
      input.setFrameBuffer(buffer);
      input.readPixels(box.min.y, box.max.y);
    }
  });
  // Halves widen where they are, from the last on.
  for (std::size_t i = halves ? texels.size() : 0; i-- > 0;) {
    std::uint16_t half = 0;
    std::memcpy(&half, out + i * size, sizeof half);
    texels[i] = imath_half_to_float(half);
  }
}

}  // namespace

std::unique_ptr<const PictureFile> open_exr(const std::string& file) {
  return std::make_unique<ExrFile>(file);
}

}  // namespace assay::render
