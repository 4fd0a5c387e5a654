#include "estimators/recorded/seen_pictures.h"

#include <array>
#include <bit>

namespace assay::recorded {

namespace {

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits), a texel at a time.
std::uint64_t step(std::uint64_t digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x100000001b3;
  return digest ^ digest >> 32;  // the product alone never carries a high bit down
}

struct Digest {
  std::uint64_t value = 0xcbf29ce484222325;
  bool finite = true;
  bool one_value = true;
};

/// In one pass. Every fourth texel goes to a digest of its own, so that none waits for the last.
Digest digest_of(std::span<const float> texels) {
  constexpr std::size_t lanes = 4;
  Digest whole;
  std::array<std::uint64_t, lanes> digests;
  digests.fill(whole.value);
  bool finite = true;
  bool differs = false;
  std::size_t i = 0;
  const auto take = [&](std::size_t lane) {
    const float texel = texels[i + lane];
    digests[lane] = step(digests[lane], std::bit_cast<std::uint32_t>(texel));
    finite &= texel - texel == 0;
    differs |= texel != texels[0];
  };
  for (; i + lanes <= texels.size(); i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) take(lane);
  }
  for (std::size_t lane = 0; i + lane < texels.size(); ++lane) take(lane);
  for (const std::uint64_t digest : digests) whole.value = step(whole.value, digest);
  whole.finite = finite;
  whole.one_value = !differs;
  return whole;
}

}  // namespace

std::optional<std::uint64_t> SeenPictures::note(std::uint64_t index,
                                                std::span<const float> texels) {
  const Digest digest = digest_of(texels);
  if (!digest.finite || digest.one_value) return {};
  const std::scoped_lock lock(mutex_);
  const std::uint64_t first = by_digest_.try_emplace(digest.value, index).first->second;
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
