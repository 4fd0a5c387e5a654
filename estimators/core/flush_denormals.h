#pragma once

#include <immintrin.h>

namespace assay {

/// Sets the processor to flush denormals to zero while it lives. Rays are traced that way, and bits
/// must not depend on which thread, or which process, drew them.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | flush_bits); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

  /// True if the calling thread flushes them.
  static bool is_on() { return (_mm_getcsr() & flush_bits) == flush_bits; }

 private:
  // _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON
  static constexpr unsigned flush_bits = 0x8040;
  unsigned saved_;
};

}  // namespace assay
