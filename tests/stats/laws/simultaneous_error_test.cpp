#include "stats/laws/simultaneous_error.h"

#include "stats/means/binomial.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(SimultaneousError, AgreesWithTransitionMatricesAtEveryStepOfGamma) {
  for (const Row& row : tests::read_table("band")) {
    SCOPED_TRACE(row.text("case"));
    const auto [n, points] = row["case"] == 0 ? std::pair{20U, 10U} : std::pair{100U, 100U};
    const double gamma = simultaneous_error(n, points, row["confidence"]);
    EXPECT_GE(gamma, row["step"] * (1 - 1e-9));
    EXPECT_NEAR(gamma / row["next_step"], 1, 3e-6);
  }
}

// Published for this band: gamma about .0041 at n = 100, 100 points, .95.
TEST(SimultaneousError, OfAHundredValuesIsTheKnownGamma) {
  EXPECT_NEAR(simultaneous_error(100, 100, .95), .0041, 5e-5);
}

/// The share of runs in which intervals at this pointwise error do not all hold the law. They stand
/// at 63 order statistics of n uniform values.
double exits(std::uint32_t test_case, std::uint64_t n, double gamma, std::size_t runs) {
  std::vector<std::pair<std::uint64_t, Interval>> bands;
  for (std::uint64_t i = 1; i < 64; ++i) {
    bands.emplace_back(i * n / 64, clopper_pearson({i * n / 64, n}, 1 - gamma));
  }
  Philox random(test_case);
  std::size_t left = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    const auto u = sorted(sample_of(n, [&] { return random.uniform(); }));
    left += std::any_of(bands.begin(), bands.end(), [&](const auto& band) {
      const double law = u[band.first - 1];
      return law < band.second.low || law > band.second.high;
    });
  }
  return static_cast<double>(left) / static_cast<double>(runs);
}

// Intervals around an empirical distribution function. Exact at n = 200, by the limit at n = 5000.
TEST(SimultaneousError, HoldsTheLawEverywhereByIntervals) {
  const double exact = exits(371, 200, simultaneous_error(200, 64, .95), 4000);
  EXPECT_FALSE(tests::too_many(exact, .05, 4000)) << exact;
  EXPECT_GT(exact, .02) << "nor are they idle";
  const double limit = exits(372, 5000, simultaneous_error(5000, 64, .95), 2000);
  EXPECT_FALSE(tests::too_many(limit, .05, 2000)) << limit;
  EXPECT_GT(limit, .02);
  EXPECT_TRUE(tests::too_many(exits(373, 200, .05, 1000), .05, 1000)) << "pointwise ones do not";
}

// Exact values at .99: 4.763694e-4 at n = 5000, 4.432e-4 at 1e5.
TEST(SimultaneousError, OfManyValuesIsNoLargerThanTheExactOne) {
  const double limit = simultaneous_error(1'000'000, 64, .99);
  EXPECT_LT(limit, 4.432e-4);
  EXPECT_GT(limit, .95 * 4.432e-4);
}

}  // namespace
}  // namespace assay::stats
