#include "render/exr/zip_chunk.h"

#include <array>
#include <cstddef>

namespace assay::render {

namespace {

using Bytes = std::span<const std::uint8_t>;

// Sums of bytes are modulo 256.
std::uint8_t sum_of(Bytes bytes) {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum + byte);
  return sum;
}

// Bytes are stored as differences to the one before, 128 added: first those at even places of the
// chunk, then those at odd ones. A run of differences that are added up from `value` on.
struct Run {
  const std::uint8_t* differences;
  std::uint8_t value;
  std::uint8_t* out;

  void step(std::size_t i) {
    value = static_cast<std::uint8_t>(value + differences[i] - 128);
    out[2 * i] = value;
  }
};

// Additions wait for each other: a half is cut into runs, of which several go on at a time.
constexpr std::size_t runs = 4;

void add_up(Bytes differences, std::span<std::uint8_t> out) {
  const std::size_t half = differences.size() / 2;
  const std::size_t length = half / runs;
  std::array<Run, 2 * runs> all{};
  std::uint8_t sum = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool odd = k >= runs;
    const std::size_t place = k % runs * length;
    const std::size_t begin = place + (odd ? half : 0);
    const std::size_t end = k + 1 == runs ? half : begin + length;
    // The byte before, less 128 for each byte up to it but one.
    const std::uint8_t before = begin % 2 == 0 ? 128 : 0;
    all[k] = {differences.data() + begin, static_cast<std::uint8_t>(sum + before),
              out.data() + 2 * place + (odd ? 1 : 0)};
    sum = static_cast<std::uint8_t>(sum + sum_of(differences.subspan(begin, end - begin)));
  }
  for (std::size_t i = 0; i < length; ++i) {
    for (Run& run : all) run.step(i);
  }
  for (std::size_t i = length; i < half - (runs - 1) * length; ++i) {
    all[runs - 1].step(i);
    all[2 * runs - 1].step(i);
  }
}

}  // namespace

bool ZipChunk::inflate(Bytes packed, std::span<std::uint8_t> out) {
  differences_.resize(out.size());
  if (!decompressor_ || out.size() % 2 != 0) return false;
  // It holds the checksum and the size against what comes out.
  const libdeflate_result result =
      libdeflate_zlib_decompress(decompressor_.get(), packed.data(), packed.size(),
                                 differences_.data(), differences_.size(), nullptr);
  if (result != LIBDEFLATE_SUCCESS) return false;
  add_up(differences_, out);
  return true;
}

}  // namespace assay::render
