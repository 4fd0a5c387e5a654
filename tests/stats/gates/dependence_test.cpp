#include "stats/gates/dependence.h"

#include "stats/means/student_t.h"
#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// make_dependence.R, sequence.
std::vector<double> sequence(double phi, std::size_t n) {
  std::vector<double> values;
  double x = 0;
  for (std::size_t t = 1; t <= n; ++t) {
    x = phi * x + std::sin(static_cast<double>(t * t));
    values.push_back(x);
  }
  return values;
}

TEST(Dependence, AgreesWithRsAcf) {
  for (const Row& row : tests::read_table("dependence")) {
    const auto x = sequence(row["phi"], static_cast<std::size_t>(row["n"]));
    SCOPED_TRACE(row.text("phi") + ", " + row.text("n"));
    EXPECT_NEAR(autocorrelation(x, 1), row["r1"], 1e-10);
    EXPECT_NEAR(autocorrelation(x, 5), row["r5"], 1e-10);
    EXPECT_NEAR(effective_sample_size(x) / row["ess"], 1, 1e-9);
    const std::size_t b = default_batch(x.size());
    EXPECT_NEAR(batch_means(x, b).variance() * static_cast<double>(b) / row["batch"], 1, 1e-9);
  }
}

TEST(Dependence, TheVarianceOfTheFirstAutocorrelationIsExactForFourValues) {
  // n = 4 normal values, 400000 samples: mean -1/4 and the variance used, within 6 standard errors.
  Philox random(501);
  Moments z;
  for (int i = 0; i < 400000; ++i)
    z.add(lag_one_test(draw_values(laws::normal, 4, random)).statistic);
  EXPECT_NEAR(z.mean, 0, 6 / std::sqrt(400000));
  EXPECT_NEAR(z.variance(), 1, 6 * std::sqrt(2.0 / 400000));
}

TEST(Dependence, ABatchIsTheRootOfTheSize) {
  EXPECT_EQ(default_batch(99), 9U);
  EXPECT_EQ(default_batch(100), 10U);
}

// ---- Level. False alarms 1e-5 each.

TEST(Dependence, TheLagOneTestIsUniformOnIndependentValues) {
  std::uint32_t test_case = 511;
  for (const Law& law :
       {laws::normal, laws::exponential, laws::lognormal_half, laws::t5, laws::uniform}) {
    SCOPED_TRACE(law.name);
    expect_calibrated({test_case++}, [&](Philox& random) {
      return log_p_two_sided(lag_one_test(draw_values(law, 200, random)));
    });
  }
}

TEST(Dependence, LongBatchesKeepTheLevelOnACorrelatedChainAndTheTTestDoesNot) {
  std::uint32_t test_case = 531;
  for (const std::size_t length : {1UL, 100UL, 333UL}) {
    Philox random(test_case++);
    int rejected = 0;
    for (int run = 0; run < 1000; ++run) {
      const Moments means = batch_means(autoregressive(.9, 10000, random), length);
      rejected += log_p_two_sided(student_t(means, {0})) <= std::log(.01);
    }
    std::cout << "  batches of " << length << ": " << rejected << " of 1000 at .01\n";
    EXPECT_EQ(length == 1, tests::too_many(rejected / 1000.0, .0125, 1000));
  }
}

CAUGHT(Dependence, TheBiasOfTheFirstAutocorrelationLeftInIsNoticed, 541, 40000) {
  const auto x = draw_values(laws::normal, 50, random);
  return normal_tails(std::sqrt(50) * autocorrelation(x, 1)).lower;
}

TEST(RankCorrelation, IsThatOfMidranks) {
  const std::vector<double> x{1, 2, 2, 4, 5, 5, 5, 9}, y{3, 1, 4, 1, 5, 9, 2, 6};
  EXPECT_NEAR(rank_correlation(x, y), 0.5495502618648208, 1e-14);  // scipy 1.10: spearmanr
  EXPECT_EQ(rank_correlation(x, std::vector<double>(8, 3.0)), 0);
}

}  // namespace
}  // namespace assay::stats
