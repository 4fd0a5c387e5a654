#include "recorded/seen_pictures.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <vector>

namespace assay::recorded {
namespace {

// Two whole pieces of 4096 texels and one that ends within a pair.
std::vector<float> ramp() {
  std::vector<float> texels(2 * 4096 + 19);
  std::iota(texels.begin(), texels.end(), 1.0F);
  return texels;
}

TEST(SeenPictures, TellsApartWhatDiffersInOneTexel) {
  SeenPictures seen;
  EXPECT_EQ(seen.note(0, ramp()), std::nullopt);
  std::uint64_t index = 0;
  for (const std::size_t at : {0U, 1U, 15U, 16U, 4095U, 4096U, 8191U, 8207U, 8209U, 8210U}) {
    std::vector<float> other = ramp();
    other[at] = -other[at];
    EXPECT_EQ(seen.note(++index, other), std::nullopt) << at;
    EXPECT_EQ(seen.note(100, other), index) << at;
  }
  EXPECT_EQ(seen.note(100, ramp()), 0U);
}

TEST(SeenPictures, CountsNoPictureOfOneValueAndNoneThatIsNotFinite) {
  SeenPictures seen;
  std::vector<float> texels(5000, 2.0F);
  for (const std::uint64_t index : {0U, 1U}) EXPECT_EQ(seen.note(index, texels), std::nullopt);
  for (std::size_t i = 4096; i < texels.size(); ++i) texels[i] = 3;
  EXPECT_EQ(seen.note(2, texels), std::nullopt);
  EXPECT_EQ(seen.note(3, texels), 2U);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    texels[4999] = bad;
    for (const std::uint64_t index : {4U, 5U}) EXPECT_EQ(seen.note(index, texels), std::nullopt);
  }
}

}  // namespace
}  // namespace assay::recorded
