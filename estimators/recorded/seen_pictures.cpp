#include "estimators/recorded/seen_pictures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace assay::recorded {

namespace {

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits), a word at a time.
std::uint64_t step(std::uint64_t digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x100000001b3;
  return digest ^ digest >> 32;  // the product alone never carries a high bit down
}

constexpr std::uint64_t basis = 0xcbf29ce484222325;

std::uint64_t word(const float* texels) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, texels, sizeof bits);
  return bits;
}

/// A digest of two texels at a time. Every eighth pair goes to a digest of its own, so that none
/// waits for the last.
std::uint64_t digest_of_bits(std::span<const float> texels) {
  constexpr std::size_t lanes = 8;
  std::uint64_t whole = basis;
  std::array<std::uint64_t, lanes> digests;
  digests.fill(whole);
  std::size_t i = 0;
  for (; i + 2 * lanes <= texels.size(); i += 2 * lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      digests[lane] = step(digests[lane], word(texels.data() + i + 2 * lane));
    }
  }
  for (const std::uint64_t digest : digests) whole = step(whole, digest);
  for (; i < texels.size(); ++i) {
    whole = step(whole, std::bit_cast<std::uint32_t>(texels[i]));
  }
  return whole;
}

}  // namespace

// By rows, which stay in the cache from one question to the next.
void PictureDigest::add(std::span<const float> texels) {
  if (!first_ && !texels.empty()) first_ = texels[0];
  for (std::size_t begin = 0; begin < texels.size(); begin += row_) {
    const std::span<const float> some = texels.subspan(begin, row_);
    value_ = step(value_, digest_of_bits(some));
    std::uint32_t beyond = 0;
    std::uint32_t differs = 0;
    for (const float texel : some) {
      constexpr std::uint32_t exponent = 0x7f800000;
      const auto bits = std::bit_cast<std::uint32_t>(texel);
      beyond |= (bits & exponent) == exponent ? 1U : 0U;
      differs |= texel != *first_ ? 1U : 0U;
    }
    finite_ &= beyond == 0;
    one_value_ &= differs == 0;
  }
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> SeenPictures::note(
    std::uint64_t index, const PictureDigest& digest) {
  if (!digest.finite() || digest.one_value()) return {};
  const std::scoped_lock lock(mutex_);
  const std::uint64_t first = by_digest_.try_emplace(digest.value(), index).first->second;
  if (first != index && !repeated_) repeated_ = std::minmax({first, index});
  return all_alike() ? std::nullopt : repeated_;
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> SeenPictures::shared_with(
    const SeenPictures& other, std::uint64_t count) const {
  const std::scoped_lock lock(mutex_, other.mutex_);
  std::optional<std::pair<std::uint64_t, std::uint64_t>> found;
  if (all_alike() || other.all_alike()) return found;
  for (const auto& [digest, index] : other.by_digest_) {
    const auto mine = by_digest_.find(digest);
    if (mine == by_digest_.end() || mine->second >= count || index >= count) continue;
    if (found && found->second < index) continue;
    found.emplace(mine->second, index);
  }
  return found;
}

}  // namespace assay::recorded
