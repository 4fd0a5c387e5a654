#pragma once

// Random numbers as a function of (key, observation, substream, draw): any observation can be drawn
// again alone, in any order, on any thread.

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace assay {

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Philox4x32-10 is a bijection of the 128-bit counters for each key, whose values are as good as
/// random. Its source is Salmon, Moraes, Dror and Shaw 2011, "Parallel random numbers: as easy as
/// 1, 2, 3". Written out because every estimator includes it and the authors' header costs a second
/// a file to compile; the tests compare the two.
inline PhiloxCounter philox(PhiloxCounter x, PhiloxKey key) {
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    const std::uint64_t p = std::uint64_t{0xD2511F53} * x[0];
    const std::uint64_t q = std::uint64_t{0xCD9E8D57} * x[2];
    x = {static_cast<std::uint32_t>(q >> 32) ^ x[1] ^ key[0], static_cast<std::uint32_t>(q),
         static_cast<std::uint32_t>(p >> 32) ^ x[3] ^ key[1], static_cast<std::uint32_t>(p)};
    key[0] += 0x9E3779B9;  // the golden ratio
    key[1] += 0xBB67AE85;  // sqrt(3) - 1
  }
  return x;
}

/// Which family of streams: Philox4x32-10's 64-bit key.
struct StreamKey {
  std::uint64_t bits = 0;
  bool operator==(const StreamKey&) const = default;
};

/// The key of an estimator's streams in a run. It is a hash of the run's seed, the plugin's name
/// (of a mutant: its original's), its canonical parameters and the copy. The copy is 0, or 1 for a
/// second source of the same key in one claim. The pilot has copies of its own.
///
/// From state 0 each 64-bit word is absorbed by
///   state = finalise((state ^ word) + 0x9e3779b97f4a7c15).
/// The words are the seed, the name, the parameters and the copy. A text is its length in bytes,
/// then its bytes by eights, little-endian, the last padded with zeros. The key is finalise(state);
/// `finalise` is SplitMix64's.
StreamKey stream_key(std::uint64_t seed, std::string_view plugin, std::string_view parameters,
                     std::uint32_t copy);

/// How a word of 64 random bits is read as a number.
namespace word {

/// Processors convert signed integers in one instruction, unsigned ones in a branch. word < 2^63.
inline double to_double(std::uint64_t word) {
  return static_cast<double>(static_cast<std::int64_t>(word));
}

/// Uniform in [0, 1): a multiple of 2^-53.
inline double uniform(std::uint64_t word) { return to_double(word >> 11) * 0x1p-53; }

/// Uniform in (0, 1): the midpoints of 2^52 cells, for logarithms and quantiles.
inline double uniform_open(std::uint64_t word) { return (to_double(word >> 12) + 0.5) * 0x1p-52; }

}  // namespace word

/// The random numbers of one observation. A uniform_random_bit_generator of 64-bit words.
/// Philox4x32-10 (Salmon et al. 2011): counter = draw, substream, observation (two words).
class Stream {
 public:
  using result_type = std::uint64_t;

  Stream(StreamKey key, std::uint64_t observation) : Stream(key, observation, 0) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    if (next_ == most_words) refill();
    return words_[next_++];
  }

  /// Says that dozens of words will be asked for: from now on they are drawn sixteen at a time, in
  /// half of the time. They are the same words.
  void draw_ahead() { ahead_ = true; }

  /// Uniform in [0, 1): a multiple of 2^-53.
  double uniform() { return word::uniform((*this)()); }

  /// Uniform in (0, 1): the midpoints of 2^52 cells, for logarithms and quantiles.
  double uniform_open() { return word::uniform_open((*this)()); }

  /// The family it is of: with the observation's index all that another program needs to draw it.
  StreamKey key() const { return {key_[0] | static_cast<std::uint64_t>(key_[1]) << 32}; }

  /// Which observation this is: the index of a row for recorded data.
  std::uint64_t observation() const {
    return counter_[2] | static_cast<std::uint64_t>(counter_[3]) << 32;
  }

  /// An independent stream of the same observation, the same whatever was drawn before. One level:
  /// a substream has no substreams. `index` below 2^32 - 1.
  Stream substream(std::uint32_t index) const;

 private:
  Stream(StreamKey key, std::uint64_t observation, std::uint32_t substream)
      : key_{{static_cast<std::uint32_t>(key.bits), static_cast<std::uint32_t>(key.bits >> 32)}},
        counter_{{0, substream, static_cast<std::uint32_t>(observation),
                  static_cast<std::uint32_t>(observation >> 32)}} {}

  void refill() {
    if (ahead_) return draw_all();
    const PhiloxCounter block = philox(counter_, key_);
    ++counter_[0];
    next_ = most_words - 2;
    words_[next_] = block[0] | static_cast<std::uint64_t>(block[1]) << 32;
    words_[next_ + 1] = block[2] | static_cast<std::uint64_t>(block[3]) << 32;
  }
  void draw_all();

  PhiloxKey key_;
  PhiloxCounter counter_;
  static constexpr std::uint32_t most_words = 16;
  bool ahead_ = false;
  std::uint32_t next_ = most_words;
  std::array<std::uint64_t, most_words> words_;  // written before they are read
};

}  // namespace assay
