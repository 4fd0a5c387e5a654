#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace assay::tests {

// A counter-based generator for the tests of `stats`: Random123's Philox4x32-10 with key {seed,
// case}. The seed of every test is 1; `test_case` only separates the streams of different tests.
class Philox {
 public:
  using result_type = std::uint32_t;

  explicit Philox(std::uint32_t test_case, std::uint32_t seed = 1) : key_{{seed, test_case}} {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xffffffffU; }

  result_type operator()() {
    if (used_ == 4) {
      block_ = r123::Philox4x32()(counter_, key_);
      counter_.incr();
      used_ = 0;
    }
    return block_[used_++];
  }

  // Uniform on the open interval, 53 bits and a half step.
  double uniform() {
    const std::uint64_t high = (*this)();
    const std::uint64_t low = (*this)();
    const std::uint64_t bits = ((high << 32) | low) >> 11;
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
  }

  double exponential() { return -std::log(uniform()); }

  double normal() {
    if (spare_ready_) {
      spare_ready_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    spare_ready_ = true;
    return radius * std::cos(angle);
  }

 private:
  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_{{0, 0, 0, 0}};
  r123::Philox4x32::ctr_type block_{{0, 0, 0, 0}};
  unsigned used_ = 4;
  double spare_ = 0;
  bool spare_ready_ = false;
};

}  // namespace assay::tests
