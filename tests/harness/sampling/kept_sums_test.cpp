#include <oneapi/tbb/global_control.h>

#include "harness/sampling/summary.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

// Pieces of 4096 elements and one that is not whole.
constexpr std::size_t elements = 10'000;
constexpr std::size_t not_finite = 9'000;

TEST(KeptSums, OfImagesAreThoseOfEveryElement) {
  tests::Philox random(1);
  std::vector<std::vector<float>> drawn(3, std::vector<float>(elements));
  for (auto& image : drawn) {
    for (float& value : image) value = static_cast<float>(random.uniform());
  }
  drawn[1][not_finite] = std::numeric_limits<float>::infinity();
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::vector<ChannelSummary> sums = sums_of_images(drawn);
    ASSERT_EQ(sums.size(), elements);
    for (std::size_t e = 0; e < elements; ++e) {
      ChannelSummary expected;
      for (std::size_t i = 0; i < 3; ++i) expected.add(drawn[i][e], i);
      EXPECT_EQ(sums[e].moments.count, expected.moments.count) << e;
      EXPECT_NEAR(sums[e].moments.mean, expected.moments.mean, 1e-15) << e;
      EXPECT_NEAR(sums[e].moments.m2, expected.moments.m2, 1e-15) << e;
      EXPECT_EQ(sums[e].nonfinite, expected.nonfinite) << e;
      EXPECT_EQ(sums[e].first_nonfinite, expected.first_nonfinite) << e;
    }
  }
}

}  // namespace
}  // namespace assay::harness
