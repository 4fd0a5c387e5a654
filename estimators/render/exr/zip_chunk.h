#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace assay::render {

/// Undoes OpenEXR's ZIP compression, by libdeflate. It takes half the time of the library's own.
class ZipChunk {
 public:
  /// False if the bytes are damaged, or not of a chunk of so many. Only whole halves or floats come
  /// to an even number of them.
  bool inflate(std::span<const std::uint8_t> packed, std::span<std::uint8_t> out);

 private:
  struct Free {
    void operator()(libdeflate_decompressor* each) const { libdeflate_free_decompressor(each); }
  };
  std::unique_ptr<libdeflate_decompressor, Free> decompressor_{libdeflate_alloc_decompressor()};
  std::vector<std::uint8_t> differences_;
};

}  // namespace assay::render
