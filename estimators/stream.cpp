#include "estimators/stream.h"

#include <cstddef>
#include <span>
#include <stdexcept>

#include "estimators/philox.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace assay {

namespace {

// A sponge over 64-bit words. Each word is added; a Weyl constant keeps a run of zeros from being a
// fixed point. Then the finaliser of SplitMix64 mixes (Steele, Lea and Flood 2014, section 4). It
// is a bijection: every input bit flips each output bit with probability near one half.
class Sponge {
 public:
  void absorb(std::uint64_t word) { state_ = finalise((state_ ^ word) + 0x9e3779b97f4a7c15u); }

  // The length comes first, so that ("ab", "c") and ("a", "bc") differ.
  void absorb(std::string_view text) {
    absorb(static_cast<std::uint64_t>(text.size()));
    for (std::size_t begin = 0; begin < text.size(); begin += 8) {
      absorb(little_endian(text.substr(begin, 8)));
    }
  }

  std::uint64_t squeeze() const { return finalise(state_); }

 private:
  static std::uint64_t little_endian(std::string_view bytes) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      word |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    }
    return word;
  }

  static std::uint64_t finalise(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_ = 0;
};

// Eight counters through Philox side by side. Ten rounds one after the other wait for each other's
// products, 20 ns a counter; eight together take 5 ns each.

/// Two counters to a register, in the lower halves of its 64-bit lanes. The upper halves hold
/// leftovers, which the products ignore.
struct PhiloxLanes {
  typedef std::uint64_t Register __attribute__((vector_size(16)));
  static constexpr std::size_t registers = 4;
  static constexpr std::size_t lanes = 2;
  static constexpr std::size_t together = registers * lanes;

  Register x0[registers];
  Register x1[registers];
  Register x2[registers];
  Register x3[registers];

  static Register everywhere(std::uint32_t word) { return Register{word, word}; }

  /// `start` and the seven that follow in its first word.
  static PhiloxLanes draws_from(const PhiloxCounter& start) {
    PhiloxLanes all;
    for (std::size_t r = 0; r < registers; ++r) {
      const std::uint64_t draw = start[0] + lanes * r;
      all.x0[r] = Register{draw, draw + 1};
      all.x1[r] = everywhere(start[1]);
      all.x2[r] = everywhere(start[2]);
      all.x3[r] = everywhere(start[3]);
    }
    return all;
  }

  void encipher(PhiloxKey key) {
    constexpr int rounds = 10;
    const Register even = everywhere(0xD2511F53);
    const Register odd = everywhere(0xCD9E8D57);
    for (int round = 0; round < rounds; ++round) {
      const Register key0 = everywhere(key[0]);
      const Register key1 = everywhere(key[1]);
      for (std::size_t r = 0; r < registers; ++r) {
        const Register p = product(even, x0[r]);
        const Register q = product(odd, x2[r]);
        x0[r] = (q >> 32) ^ x1[r] ^ key0;
        x2[r] = (p >> 32) ^ x3[r] ^ key1;
        x1[r] = q;
        x3[r] = p;
      }
      key[0] += 0x9E3779B9;
      key[1] += 0xBB67AE85;
    }
  }

  /// Words of 64 bits, two of a counter, as a stream reads them.
  void write(std::span<std::uint64_t, 2 * together> words) const {
    for (std::size_t r = 0; r < registers; ++r) {
      const Register one = joined(x0[r], x1[r]);
      const Register two = joined(x2[r], x3[r]);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        words[2 * (lanes * r + lane)] = one[lane];
        words[2 * (lanes * r + lane) + 1] = two[lane];
      }
    }
  }

 private:
  /// The products of the lower halves of the lanes.
  static Register product(Register a, Register b) {
#ifdef __SSE2__
    // One instruction. The compiler makes three of the line below.
    return reinterpret_cast<Register>(
        _mm_mul_epu32(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
    return (a & everywhere(0xFFFFFFFF)) * (b & everywhere(0xFFFFFFFF));
#endif
  }

  /// The lower halves of two registers as words of 64 bits.
  static Register joined(Register low, Register high) {
    return (low & everywhere(0xFFFFFFFF)) | high << 32;
  }
};

}  // namespace

StreamKey stream_key(std::uint64_t seed, std::string_view plugin, std::string_view parameters,
                     std::uint32_t copy) {
  Sponge sponge;
  sponge.absorb(seed);
  sponge.absorb(plugin);
  sponge.absorb(parameters);
  sponge.absorb(static_cast<std::uint64_t>(copy));
  return {sponge.squeeze()};
}

Stream Stream::substream(std::uint32_t index) const {
  if (counter_[1] != 0) throw std::logic_error("Stream: a substream has no substreams");
  if (index == std::numeric_limits<std::uint32_t>::max()) {
    throw std::logic_error("Stream: a substream's index is below 2^32 - 1");
  }
  return {key(), observation(), index + 1};
}

void Stream::draw_all() {
  PhiloxLanes draws = PhiloxLanes::draws_from(counter_);
  draws.encipher(key_);
  draws.write(words_);
  counter_[0] += PhiloxLanes::together;
  next_ = 0;
}

}  // namespace assay
