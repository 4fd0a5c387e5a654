#pragma once

#include <cstdint>
#include <string_view>

namespace assay::harness {

/// Fowler, Noll and Vo's 64-bit hash FNV-1a: tells texts apart that differ by accident, not those
/// that someone made to agree. `start` continues the hash of what came before.
constexpr std::uint64_t text_hash(std::string_view text,
                                  std::uint64_t start = 0xcbf29ce484222325U) {
  for (const char c : text) {
    start ^= static_cast<unsigned char>(c);
    start *= 0x100000001b3U;
  }
  return start;
}

}  // namespace assay::harness
