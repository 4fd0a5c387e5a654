#pragma once

#include <cstdint>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace assay {

/// Sets the processor to flush denormals to zero while it lives. Rays are traced that way, and bits
/// must not depend on which thread, or which process, drew them.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(control()) { set_control(saved_ | flush_bits); }
  ~FlushDenormals() { set_control(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

  /// True if the calling thread flushes them.
  static bool is_on() { return (control() & flush_bits) == flush_bits; }

 private:
#ifdef __SSE2__
  using Control = unsigned;
  // _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON
  static constexpr Control flush_bits = 0x8040;
  static Control control() { return _mm_getcsr(); }
  static void set_control(Control bits) { _mm_setcsr(bits); }
#elif defined(__aarch64__)
  using Control = std::uint64_t;
  static constexpr Control flush_bits = 1 << 24;  // FPCR.FZ, of operands and results
  static Control control() {
    Control bits = 0;
    asm volatile("mrs %0, fpcr" : "=r"(bits));
    return bits;
  }
  static void set_control(Control bits) { asm volatile("msr fpcr, %0" : : "r"(bits) : "memory"); }
#else
#error "how does this processor flush denormals to zero?"
#endif
  Control saved_;
};

}  // namespace assay
