#include "estimators/first_words.h"

#include <emmintrin.h>

namespace assay {
namespace {

// Two streams to a register, in the lower halves of its 64-bit lanes; what stands in the upper
// halves is left there, as the products do not see it.
constexpr std::size_t registers = 4;
constexpr std::size_t lanes = 2;
constexpr std::size_t together = registers * lanes;
constexpr int rounds = 10;

__m128i everywhere(std::uint32_t word) { return _mm_set1_epi64x(static_cast<long long>(word)); }

struct Counters {
  __m128i x0[registers];
  __m128i x1[registers];
  __m128i x2[registers];
  __m128i x3[registers];
};

/// Draw 0, substream 0 of observations `first` on.
Counters counters_from(std::uint64_t first) {
  Counters c;
  for (std::size_t r = 0; r < registers; ++r) {
    const std::uint64_t observation = first + lanes * r;
    c.x0[r] = c.x1[r] = _mm_setzero_si128();
    c.x2[r] = _mm_set_epi64x(static_cast<long long>(observation + 1),
                             static_cast<long long>(observation));
    c.x3[r] = _mm_srli_epi64(c.x2[r], 32);
  }
  return c;
}

/// Draws `first` on of one observation's substream 0.
Counters draws_from(std::uint64_t observation, std::uint32_t first) {
  Counters c;
  for (std::size_t r = 0; r < registers; ++r) {
    const long long draw = first + static_cast<long long>(lanes * r);
    c.x0[r] = _mm_set_epi64x(draw + 1, draw);
    c.x1[r] = _mm_setzero_si128();
    c.x2[r] = everywhere(static_cast<std::uint32_t>(observation));
    c.x3[r] = everywhere(static_cast<std::uint32_t>(observation >> 32));
  }
  return c;
}

void philox_of_all(Counters& c, PhiloxKey key) {
  const __m128i even = everywhere(0xD2511F53);
  const __m128i odd = everywhere(0xCD9E8D57);
  for (int round = 0; round < rounds; ++round) {
    const __m128i key0 = everywhere(key[0]);
    const __m128i key1 = everywhere(key[1]);
    for (std::size_t r = 0; r < registers; ++r) {
      const __m128i p = _mm_mul_epu32(even, c.x0[r]);
      const __m128i q = _mm_mul_epu32(odd, c.x2[r]);
      c.x0[r] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(q, 32), c.x1[r]), key0);
      c.x2[r] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(p, 32), c.x3[r]), key1);
      c.x1[r] = q;
      c.x3[r] = p;
    }
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
}

/// The lower halves of two registers as words of 64 bits.
std::array<std::uint64_t, lanes> joined(__m128i low, __m128i high) {
  const __m128i lower = _mm_and_si128(low, everywhere(0xFFFFFFFF));
  std::array<std::uint64_t, lanes> words;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(words.data()),
                   _mm_or_si128(lower, _mm_slli_epi64(high, 32)));
  return words;
}

PhiloxKey halves_of(StreamKey key) {
  return {static_cast<std::uint32_t>(key.bits), static_cast<std::uint32_t>(key.bits >> 32)};
}

}  // namespace

void first_words(StreamKey key, std::uint64_t first, std::span<FirstWords> words) {
  std::size_t done = 0;
  for (; done + together <= words.size(); done += together) {
    Counters c = counters_from(first + done);
    philox_of_all(c, halves_of(key));
    for (std::size_t r = 0; r < registers; ++r) {
      const auto one = joined(c.x0[r], c.x1[r]);
      const auto two = joined(c.x2[r], c.x3[r]);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        words[done + lanes * r + lane] = {one[lane], two[lane]};
      }
    }
  }
  for (; done < words.size(); ++done) {
    Stream stream(key, first + done);
    const std::uint64_t one = stream();
    words[done] = {one, stream()};
  }
}

void LongStream::refill() {
  for (std::size_t done = 0; done < words_.size(); done += 2 * together) {
    Counters c = draws_from(observation_, draw_);
    philox_of_all(c, halves_of(key_));
    for (std::size_t r = 0; r < registers; ++r) {
      const auto one = joined(c.x0[r], c.x1[r]);
      const auto two = joined(c.x2[r], c.x3[r]);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        words_[done + 2 * (lanes * r + lane)] = one[lane];
        words_[done + 2 * (lanes * r + lane) + 1] = two[lane];
      }
    }
    draw_ += together;
  }
  next_ = 0;
}

}  // namespace assay
