#include "recorded/seen_pictures.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <vector>

namespace assay::recorded {
namespace {

// Rows that end within a pair.
constexpr std::size_t row = 2737;

std::vector<float> ramp() {
  std::vector<float> texels(3 * row);
  std::iota(texels.begin(), texels.end(), 1.0F);
  return texels;
}

PictureDigest digest_of(const std::vector<float>& texels, std::size_t in_row = row) {
  PictureDigest digest(in_row);
  digest.add(texels);
  return digest;
}

TEST(PictureDigest, IsTheSameInWhicheverPortionsRowsCome) {
  const std::vector<float> texels = ramp();
  PictureDigest digest(row);
  digest.add(std::span(texels).first(2 * row));
  EXPECT_NE(digest.value(), digest_of(texels).value());
  digest.add(std::span(texels).last(row));
  EXPECT_EQ(digest.value(), digest_of(texels).value());
  EXPECT_FALSE(digest.one_value());
}

TEST(SeenPictures, TellsApartWhatDiffersInOneTexel) {
  SeenPictures seen;
  EXPECT_EQ(seen.note(0, digest_of(ramp())), std::nullopt);
  std::uint64_t index = 0;
  for (const std::size_t at : {0U, 1U, 15U, 16U, 2736U, 2737U, 5473U, 5474U, 8207U, 8209U, 8210U}) {
    std::vector<float> other = ramp();
    other[at] = -other[at];
    EXPECT_EQ(seen.note(++index, digest_of(other)), std::nullopt) << at;
    EXPECT_EQ(seen.note(100, digest_of(other)), index) << at;
  }
  EXPECT_EQ(seen.note(100, digest_of(ramp())), 0U);
}

TEST(SeenPictures, CountsNoPictureOfOneValueAndNoneThatIsNotFinite) {
  SeenPictures seen;
  std::vector<float> texels(5000, 2.0F);
  const auto note = [&](std::uint64_t index) { return seen.note(index, digest_of(texels, 1000)); };
  for (const std::uint64_t index : {0U, 1U}) EXPECT_EQ(note(index), std::nullopt);
  for (std::size_t i = 4096; i < texels.size(); ++i) texels[i] = 3;
  EXPECT_EQ(note(2), std::nullopt);
  EXPECT_EQ(note(3), 2U);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    texels[4999] = bad;
    for (const std::uint64_t index : {4U, 5U}) EXPECT_EQ(note(index), std::nullopt);
  }
}

}  // namespace
}  // namespace assay::recorded
