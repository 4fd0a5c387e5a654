#include "render/exr/exr_scan_lines.h"

#include <openexr.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "render/exr/core_file.h"
#include "render/exr/zip_chunk.h"

namespace assay::render {

namespace {

// From one line to the next: the core counts bytes in 32 bits.
constexpr std::size_t most_apart = std::numeric_limits<std::int32_t>::max() / sizeof(float);

class ScanLines {
 public:
  ScanLines(const CoreFile& file, const ScanLineTexels& to) : to_(to), context_(file.context()) {}
  ~ScanLines() {
    if (initialized_) exr_decoding_destroy(context_, &pipeline_);
  }
  ScanLines(const ScanLines&) = delete;
  ScanLines& operator=(const ScanLines&) = delete;

  bool read() {
    if (!of_this_kind() || !of_this_size()) return false;
    const auto lines = static_cast<std::size_t>(lines_);
    if (to_.first % lines != 0 || (to_.last % lines != 0 && to_.last != to_.height)) return false;
    for (std::size_t row = to_.first; row < to_.last; row += lines) {
      if (!read_chunk(row)) return false;
    }
    return true;
  }

 private:
  bool of_this_kind() {
    exr_storage_t storage{};
    exr_compression_t compression{};
    return exr_get_storage(context_, to_.part, &storage) == EXR_ERR_SUCCESS &&
           exr_get_compression(context_, to_.part, &compression) == EXR_ERR_SUCCESS &&
           storage == EXR_STORAGE_SCANLINE &&
           (compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP);
  }

  bool of_this_size() {
    exr_attr_box2i_t window{};
    if (exr_get_data_window(context_, to_.part, &window) != EXR_ERR_SUCCESS ||
        exr_get_scanlines_per_chunk(context_, to_.part, &lines_) != EXR_ERR_SUCCESS) {
      return false;
    }
    top_ = window.min.y;
    const auto extent = [](std::int64_t low, std::int64_t high) {
      return static_cast<std::size_t>(high - low + 1);
    };
    const bool strides_fit = to_.width * to_.apart <= most_apart;
    return strides_fit && lines_ > 0 && extent(window.min.x, window.max.x) == to_.width &&
           extent(window.min.y, window.max.y) == to_.height;
  }

  bool read_chunk(std::size_t row) {
    exr_chunk_info_t chunk{};
    if (exr_read_scanline_chunk_info(context_, to_.part, top_ + static_cast<int>(row), &chunk) !=
            EXR_ERR_SUCCESS ||
        (initialized_ ? exr_decoding_update : exr_decoding_initialize)(
            context_, to_.part, &chunk, &pipeline_) != EXR_ERR_SUCCESS) {
      return false;
    }
    const bool first = !initialized_;
    initialized_ = true;
    if (!point_channels(row, static_cast<std::size_t>(chunk.height))) return false;
    if (first && !choose_routines()) return false;
    return exr_decoding_run(context_, to_.part, &pipeline_) == EXR_ERR_SUCCESS;
  }

  bool choose_routines() {
    pipeline_.decoding_user_data = &zip_;
    const bool chosen =
        exr_decoding_choose_default_routines(context_, to_.part, &pipeline_) == EXR_ERR_SUCCESS;
    pipeline_.decompress_fn = inflate;
    return chosen;
  }

  // A chunk that compression would have made larger is stored as it is; the core has made room.
  static exr_result_t inflate(exr_decode_pipeline_t* pipeline) {
    const auto* const packed = static_cast<const std::uint8_t*>(pipeline->packed_buffer);
    auto* const unpacked = static_cast<std::uint8_t*>(pipeline->unpacked_buffer);
    const exr_chunk_info_t& chunk = pipeline->chunk;
    if (packed == nullptr || unpacked == nullptr) return EXR_ERR_INVALID_ARGUMENT;
    if (chunk.packed_size == chunk.unpacked_size) {
      if (packed != unpacked) std::copy_n(packed, chunk.packed_size, unpacked);
      return EXR_ERR_SUCCESS;
    }
    auto& zip = *static_cast<ZipChunk*>(pipeline->decoding_user_data);
    return zip.inflate({packed, chunk.packed_size}, {unpacked, chunk.unpacked_size})
               ? EXR_ERR_SUCCESS
               : EXR_ERR_CORRUPT_CHUNK;
  }

  // Sets the place of this chunk's texels. Channels that nobody asks for go nowhere.
  bool point_channels(std::size_t row, std::size_t rows) {
    if (row + rows > to_.last) return false;
    std::size_t found = 0;
    for (int i = 0; i < pipeline_.channel_count; ++i) {
      exr_coding_channel_info_t& channel = pipeline_.channels[i];
      const auto wanted = to_.channels.find(channel.channel_name);
      channel.decode_to_ptr = nullptr;
      if (wanted == to_.channels.end()) continue;
      const bool plain =
          channel.data_type == EXR_PIXEL_FLOAT && channel.x_samples == 1 && channel.y_samples == 1;
      if (!plain) return false;
      ++found;
      const std::size_t texel = to_.apart * sizeof(float);
      float* const first = wanted->second + (row - to_.first) * to_.width * to_.apart;
      channel.decode_to_ptr = reinterpret_cast<std::uint8_t*>(first);
      channel.user_pixel_stride = static_cast<std::int32_t>(texel);
      channel.user_line_stride = static_cast<std::int32_t>(texel * to_.width);
      channel.user_bytes_per_element = sizeof(float);
      channel.user_data_type = EXR_PIXEL_FLOAT;
    }
    return found == to_.channels.size();
  }

  const ScanLineTexels& to_;
  ZipChunk zip_;
  exr_const_context_t context_;
  exr_decode_pipeline_t pipeline_ = EXR_DECODE_PIPELINE_INITIALIZER;
  std::int32_t lines_ = 0;
  int top_ = 0;
  bool initialized_ = false;
};

}  // namespace

bool read_scan_lines(const CoreFile& file, const ScanLineTexels& to) {
  return ScanLines(file, to).read();
}

}  // namespace assay::render
