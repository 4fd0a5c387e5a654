#include "estimators/stream.h"

#include <cstddef>
#include <stdexcept>

namespace assay {

namespace {

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    word |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return word;
}

std::uint64_t finalise(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

// A sponge over 64-bit words. Each word is added; a Weyl constant keeps a run of zeros from being a
// fixed point. Then the finaliser of SplitMix64 mixes (Steele, Lea and Flood 2014, section 4). It
// is a bijection: every input bit flips each output bit with probability near one half.
StreamKey stream_key(std::uint64_t seed, std::string_view plugin, std::string_view parameters,
                     std::uint32_t copy) {
  std::uint64_t state = 0;
  const auto absorb = [&](std::uint64_t word) {
    state = finalise((state ^ word) + 0x9e3779b97f4a7c15u);
  };
  absorb(seed);
  for (const std::string_view text : {plugin, parameters}) {
    // The length comes first, so that ("ab", "c") and ("a", "bc") differ.
    absorb(text.size());
    for (std::size_t begin = 0; begin < text.size(); begin += 8) {
      absorb(little_endian(text.substr(begin, 8)));
    }
  }
  absorb(copy);
  return {finalise(state)};
}

Stream Stream::substream(std::uint32_t index) const {
  if (counter_[1] != 0) throw std::logic_error("Stream: a substream has no substreams");
  if (index == std::numeric_limits<std::uint32_t>::max()) {
    throw std::logic_error("Stream: a substream's index is below 2^32 - 1");
  }
  return {key(), observation(), index + 1};
}

void Stream::draw_all() {
  for (std::size_t i = 0; i < words_.size(); i += 2, ++counter_[0]) {
    const PhiloxCounter block = philox(counter_, key_);
    words_[i] = block[0] | static_cast<std::uint64_t>(block[1]) << 32U;
    words_[i + 1] = block[2] | static_cast<std::uint64_t>(block[3]) << 32U;
  }
  next_ = 0;
}

}  // namespace assay
