#pragma once

// Eight counters through Philox side by side. Ten rounds one after the other wait for each other's
// products, 20 ns a counter; eight together take 5 ns each.

#include <emmintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "estimators/philox.h"

namespace assay {

/// Two counters to a register, in the lower halves of its 64-bit lanes. The upper halves hold
/// leftovers, which the products ignore.
struct PhiloxLanes {
  static constexpr std::size_t registers = 4;
  static constexpr std::size_t lanes = 2;
  static constexpr std::size_t together = registers * lanes;

  __m128i x0[registers];
  __m128i x1[registers];
  __m128i x2[registers];
  __m128i x3[registers];

  static __m128i everywhere(std::uint32_t word) {
    return _mm_set1_epi64x(static_cast<long long>(word));
  }

  /// `start` and the seven that follow in its first word.
  static PhiloxLanes draws_from(const PhiloxCounter& start) {
    PhiloxLanes all;
    for (std::size_t r = 0; r < registers; ++r) {
      const long long draw = start[0] + static_cast<long long>(lanes * r);
      all.x0[r] = _mm_set_epi64x(draw + 1, draw);
      all.x1[r] = everywhere(start[1]);
      all.x2[r] = everywhere(start[2]);
      all.x3[r] = everywhere(start[3]);
    }
    return all;
  }

  void encipher(PhiloxKey key) {
    constexpr int rounds = 10;
    const __m128i even = everywhere(0xD2511F53);
    const __m128i odd = everywhere(0xCD9E8D57);
    for (int round = 0; round < rounds; ++round) {
      const __m128i key0 = everywhere(key[0]);
      const __m128i key1 = everywhere(key[1]);
      for (std::size_t r = 0; r < registers; ++r) {
        const __m128i p = _mm_mul_epu32(even, x0[r]);
        const __m128i q = _mm_mul_epu32(odd, x2[r]);
        x0[r] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(q, 32), x1[r]), key0);
        x2[r] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(p, 32), x3[r]), key1);
        x1[r] = q;
        x3[r] = p;
      }
      key[0] += 0x9E3779B9;
      key[1] += 0xBB67AE85;
    }
  }

  /// Calls take(counter, first word, second word) of 64 bits each, as a stream reads them.
  template <class Take>
  void words(const Take& take) const {
    for (std::size_t r = 0; r < registers; ++r) {
      const auto one = joined(x0[r], x1[r]);
      const auto two = joined(x2[r], x3[r]);
      for (std::size_t lane = 0; lane < lanes; ++lane) take(lanes * r + lane, one[lane], two[lane]);
    }
  }

 private:
  /// The lower halves of two registers as words of 64 bits.
  static std::array<std::uint64_t, lanes> joined(__m128i low, __m128i high) {
    const __m128i lower = _mm_and_si128(low, everywhere(0xFFFFFFFF));
    std::array<std::uint64_t, lanes> words;
    _mm_storeu_si128(reinterpret_cast<__m128i*>(words.data()),
                     _mm_or_si128(lower, _mm_slli_epi64(high, 32)));
    return words;
  }
};

}  // namespace assay
