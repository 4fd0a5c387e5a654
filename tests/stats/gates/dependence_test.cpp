#include "stats/gates/dependence.h"

#include "stats/basics/errors.h"
#include "stats/means/student_t.h"
#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"
#include "tests/stats/laws.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

namespace laws = tests::laws;

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
    EXPECT_NEAR(batch_variance(x, b) / row["batch"], 1, 1e-9);
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

TEST(Dependence, TheEffectiveSizeOfAnAutoregressionIsItsClosedForm) {
  // Relative spread of the estimate at n = 40000 is below .05 for these phi. Six of them are
  // allowed.
  std::uint32_t test_case = 502;
  for (const double phi : {0.0, .5, .9}) {
    Philox random(test_case++);
    const double expected = 40000 * (1 - phi) / (1 + phi);
    const double seen = effective_sample_size(autoregressive(phi, 40000, random));
    std::printf("  phi %.1f: %.0f, closed form %.0f\n", phi, seen, expected);
    EXPECT_NEAR(seen / expected, 1, .3);
  }
}

TEST(Dependence, BadArgumentsAreNamed) {
  const std::vector<double> x{1, 2, 3, 5, 8, 13};
  const std::vector<double> constant(6, 1.0);
  EXPECT_THROW(autocorrelation(x, 6), std::domain_error);
  EXPECT_THROW(autocorrelation(constant, 1), ZeroVariance);
  EXPECT_THROW(lag_one_test(std::vector<double>{1, 2, 3}), std::domain_error);
  EXPECT_THROW(lag_one_test(std::vector<double>{1, 2, 3, NAN}), std::domain_error);
  EXPECT_THROW(effective_sample_size(constant), ZeroVariance);
  EXPECT_THROW(batch_means(x, 0), std::domain_error);
  EXPECT_THROW(batch_means(x, 4), std::domain_error);
  EXPECT_EQ(default_batch(99), 9U);
  EXPECT_EQ(default_batch(100), 10U);
}

// ---- Level. False alarms 1e-5 each.

tests::Calibration lag_one_calibration(const Law& law, std::size_t n, std::uint32_t test_case) {
  return tests::calibrate({test_case, 20000}, [&](Philox& random) {
    return log_p_two_sided(lag_one_test(draw_values(law, n, random)));
  });
}

TEST(Dependence, TheLagOneTestIsUniformOnIndependentValues) {
  std::uint32_t test_case = 511;
  for (const Law& law :
       {laws::normal, laws::exponential, laws::lognormal_half, laws::t5, laws::uniform}) {
    const auto calibration = lag_one_calibration(law, 200, test_case++);
    std::printf("  %s: %s\n", law.name, calibration.text().c_str());
    EXPECT_TRUE(calibration.ok) << law.name << calibration.text();
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
    std::printf("  batches of %zu: %.4f at .01\n", length, rejected / 1000.0);
    EXPECT_EQ(length == 1, tests::too_many(rejected / 1000.0, .0125, 1000));
  }
}

// ---- Mutants

TEST(Dependence, TheBiasOfTheFirstAutocorrelationLeftInIsNoticed) {
  const auto calibration = tests::calibrate({541, 40000}, [](Philox& random) {
    const auto x = draw_values(laws::normal, 50, random);
    return normal_tails(std::sqrt(50) * autocorrelation(x, 1)).lower;
  });
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

TEST(Dependence, ACorrelationOfATenthIsFoundInTwoThousandValues) {
  // z = 4.5 on average: p above .05 has probability 2e-3 a run, five of 20 below 1e-9.
  Philox random(542);
  int missed = 0;
  for (int run = 0; run < 20; ++run) {
    missed += lag_one_test(autoregressive(.1, 2000, random)).log_p_upper > std::log(.05);
  }
  EXPECT_LT(missed, 5);
}

}  // namespace
}  // namespace assay::stats
