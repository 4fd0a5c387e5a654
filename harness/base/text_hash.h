#pragma once

#include <cstdint>
#include <string_view>

namespace assay::harness {

/// The 64-bit hash FNV-1a (Fowler, Noll, Vo). It is no protection against deliberate collisions.
/// `start` is the hash of the text before.
constexpr std::uint64_t text_hash(std::string_view text,
                                  std::uint64_t start = 0xcbf29ce484222325U) {
  for (const char c : text) {
    start ^= static_cast<unsigned char>(c);
    start *= 0x100000001b3U;
  }
  return start;
}

}  // namespace assay::harness
