#include "estimators/recorded/seen_pictures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace assay::recorded {

namespace {

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits), a texel at a time.
std::uint64_t digest_of(std::span<const float> texels) {
  std::uint64_t digest = 0xcbf29ce484222325;
  for (const float texel : texels) {
    digest = (digest ^ std::bit_cast<std::uint32_t>(texel)) * 0x100000001b3;
    digest ^= digest >> 32;  // the product alone never carries a high bit down
  }
  return digest;
}

}  // namespace

std::optional<std::uint64_t> SeenPictures::note(std::uint64_t index,
                                                std::span<const float> texels) {
  const auto finite = [](float texel) { return std::isfinite(texel); };
  if (!std::ranges::all_of(texels, finite)) return {};
  if (std::ranges::adjacent_find(texels, std::not_equal_to<>()) == texels.end()) return {};
  const std::uint64_t digest = digest_of(texels);
  const std::scoped_lock lock(mutex_);
  const std::uint64_t first = by_digest_.try_emplace(digest, index).first->second;
  return first == index ? std::nullopt : std::optional(first);
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> SeenPictures::shared_with(
    const SeenPictures& other) const {
  const std::scoped_lock lock(mutex_, other.mutex_);
  std::optional<std::pair<std::uint64_t, std::uint64_t>> found;
  for (const auto& [digest, index] : other.by_digest_) {
    const auto mine = by_digest_.find(digest);
    if (mine == by_digest_.end() || (found && found->second < index)) continue;
    found.emplace(mine->second, index);
  }
  return found;
}

}  // namespace assay::recorded
