#include "recorded/picture_setup.h"

#include "tests/prelude.h"

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

using Two = std::pair<std::uint64_t, std::uint64_t>;

TEST(SeenPictures, TellsApartWhatDiffersInOneTexel) {
  for (const std::size_t at : {0U, 1U, 15U, 16U, 2736U, 2737U, 5473U, 5474U, 8207U, 8209U, 8210U}) {
    SeenPictures seen;
    EXPECT_EQ(seen.note(0, digest_of(ramp())), std::nullopt);
    std::vector<float> other = ramp();
    other[at] = -other[at];
    EXPECT_EQ(seen.note(1, digest_of(other)), std::nullopt) << at;
    EXPECT_EQ(seen.note(2, digest_of(other)), Two(1, 2)) << at;
  }
}

TEST(SeenPictures, CountsNoPictureOfOneValueAndNoneThatIsNotFinite) {
  SeenPictures seen;
  std::vector<float> texels(5000, 2.0F);
  const auto note = [&](std::uint64_t index) { return seen.note(index, digest_of(texels, 1000)); };
  for (const std::uint64_t index : {0U, 1U}) EXPECT_EQ(note(index), std::nullopt);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    texels[4999] = bad;
    for (const std::uint64_t index : {4U, 5U}) EXPECT_EQ(note(index), std::nullopt);
  }
}

// A layer without noise, such as depth, is the same in all renders.
TEST(SeenPictures, CountsNoneWhereAllAreAlike) {
  SeenPictures seen;
  SeenPictures other;
  for (std::uint64_t index = 0; index < 9; ++index) {
    EXPECT_EQ(seen.note(index, digest_of(ramp())), std::nullopt);
    EXPECT_EQ(other.note(index, digest_of(ramp())), std::nullopt);
  }
  EXPECT_EQ(seen.shared_with(other, 9), std::nullopt);
  std::vector<float> differs = ramp();
  differs[7] = -1;
  EXPECT_EQ(seen.note(9, digest_of(differs)), Two(0, 1));
}

}  // namespace
}  // namespace assay::recorded
