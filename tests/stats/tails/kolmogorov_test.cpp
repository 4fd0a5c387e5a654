#include "stats/tails/kolmogorov.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

double upper(double d, std::uint64_t n) { return std::exp(kolmogorov_tails(d, n).upper); }

TEST(Kolmogorov, GoldenValuesToThePrintedDigits) {
  EXPECT_NEAR(upper(.3, 10) / .2705355748, 1, 1e-10);
  EXPECT_NEAR(upper(.2, 100) / 5.55192732799e-4, 1, 1e-10);
  EXPECT_NEAR(upper(.08, 1000) / 5.15418938479e-6, 1, 1e-10);
  EXPECT_NEAR(upper(.01, 100000) / 4.09327802355e-9, 1, 1e-10);
  EXPECT_NEAR(upper(.004, 1000000) / 2.52581841434e-14, 1, 1e-10);
}

TEST(Kolmogorov, AgreesWithSixtyDigitMatricesAndScipy) {
  for (const tests::Row& row : tests::read_table("kolmogorov")) {
    const double computed = upper(row["d"], static_cast<std::uint64_t>(row["n"]));
    const double expected = row["upper_tail"];
    // scipy's own error: up to 2e-9 absolute in the body (Pelz-Good at n >= 5000).
    const bool digits = row.text("source") == "durbin-60-digits";
    EXPECT_NEAR(computed, expected,
                (digits ? 1e-10 : 1e-8) * (row.text("source") == "scipy" ? 1 : expected))
        << row["d"] << " " << row["n"];
  }
}

TEST(Kolmogorov, TailsFollowEachOtherAcrossTheSeamsOfTheAlgorithm) {
  for (const std::uint64_t n : {1ULL, 2ULL, 3ULL, 7ULL, 50ULL, 141ULL, 500ULL, 501ULL, 3000ULL,
                                100000ULL, 100001ULL, 1000000ULL}) {
    double last = 0;
    for (int i = 1; i < 400; ++i) {
      const double d = i / 400.0 * std::min(1.0, 4 / std::sqrt(static_cast<double>(n)));
      const double now = kolmogorov_tails(d, n).upper;
      EXPECT_LE(now, last + 1e-9) << n << " " << d;
      last = now;
    }
  }
}

TEST(Kolmogorov, LogarithmsReachFarBeyondTheRangeOfProbabilities) {
  // 2 exp(-2 n d^2) is Massart's upper bound, close in the tail.
  const double log_p = kolmogorov_tails(.1, 1000000).upper;
  EXPECT_LE(log_p, std::log(2) - 20000);
  EXPECT_NEAR(log_p / -20000, 1, .01);
  EXPECT_TRUE(std::isfinite(kolmogorov_tails(1, 10).upper));
  EXPECT_NEAR(kolmogorov_tails(.999, 20).upper, std::log(2) + 20 * std::log(.001), 1e-9);
}

TEST(Kolmogorov, OneSidedLawHasItsClosedFormForOneAndTwoValues) {
  EXPECT_NEAR(std::exp(log_smirnov_one_sided(.3, 1)), .7, 1e-14);
  // n = 2: d [(1-d)^2 / d + 2 (1/2 - d)] for d < 1/2
  EXPECT_NEAR(std::exp(log_smirnov_one_sided(.3, 2)), .49 + .3 * 2 * .2, 1e-14);
}

TEST(Kolmogorov, LimitLawSeriesMeetAtOne) {
  EXPECT_NEAR(log_kolmogorov_limit(std::nextafter(1, 0)), log_kolmogorov_limit(1), 1e-12);
  EXPECT_NEAR(std::exp(log_kolmogorov_limit(1.3580986393225505)), .05, 1e-10);
}

TEST(Kolmogorov, QuantilesInvertTheTail) {
  for (const std::uint64_t n : {1ULL, 5ULL, 200ULL, 10000ULL, 1000000ULL}) {
    for (const double log_p : {std::log(.5), std::log(.01), std::log(1e-6), -200.0}) {
      if (log_p < -20 && n < 20) continue;  // 1 - d would not be representable
      const double d = kolmogorov_upper_quantile(log_p, n);
      EXPECT_NEAR(kolmogorov_tails(d, n).upper, log_p, 1e-6 * -log_p) << n;
    }
  }
}

}  // namespace
}  // namespace assay::stats
