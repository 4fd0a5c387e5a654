#include <oneapi/tbb/global_control.h>

#include "harness/sampling/summary.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

// Pieces of 4096 channels and one that is not whole.
constexpr std::size_t kept_channels = 10'000;
constexpr std::size_t not_finite = 9'000;

template <class Real>
std::vector<std::vector<Real>> drawn() {
  tests::Philox random(1);
  std::vector<std::vector<Real>> observations(3, std::vector<Real>(kept_channels));
  for (auto& observation : observations) {
    for (Real& value : observation) value = static_cast<Real>(random.uniform());
  }
  observations[1][not_finite] = std::numeric_limits<Real>::infinity();
  return observations;
}

template <class Real>
void expect_channel(const ChannelSummary& sums, const std::vector<std::vector<Real>>& observations,
                    std::size_t channel) {
  ChannelSummary expected;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    add_observation(expected, static_cast<double>(observations[i][channel]), i);
  }
  EXPECT_EQ(sums.moments.count, expected.moments.count) << channel;
  EXPECT_NEAR(sums.moments.mean, expected.moments.mean, 1e-15) << channel;
  EXPECT_NEAR(sums.moments.m2, expected.moments.m2, 1e-15) << channel;
  EXPECT_EQ(sums.nonfinite, expected.nonfinite) << channel;
  EXPECT_EQ(sums.first_nonfinite, expected.first_nonfinite) << channel;
}

TEST(KeptSums, AreThoseOfEveryChannelOfObservations) {
  const auto observations = drawn<double>();
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const std::vector<ChannelSummary> sums =
        sums_of_kept(std::span<const std::vector<double>>(observations));
    ASSERT_EQ(sums.size(), kept_channels);
    for (std::size_t c = 0; c < kept_channels; ++c) expect_channel(sums[c], observations, c);
  }
}

TEST(KeptSums, OfPicturesHaveThatOfTheirAverageLast) {
  const auto observations = drawn<float>();
  const std::vector<std::span<const float>> pictures(observations.begin(), observations.end());
  const std::vector<ChannelSummary> sums =
      sums_of_kept(std::span<const std::span<const float>>(pictures));
  ASSERT_EQ(sums.size(), kept_channels + 1);
  for (std::size_t c = 0; c < kept_channels; ++c) expect_channel(sums[c], observations, c);
  double sum = 0;
  for (const float value : observations[0]) sum += double{value};
  EXPECT_EQ(sums.back().first_nonfinite, 1u);
  EXPECT_NEAR(sums.back().moments.minimum + sums.back().moments.maximum,
              2 * sums.back().moments.mean, 1e-15);
  EXPECT_TRUE(std::abs(sums.back().moments.minimum - sum / kept_channels) < 1e-12 ||
              std::abs(sums.back().moments.maximum - sum / kept_channels) < 1e-12);
}

}  // namespace
}  // namespace assay::harness
