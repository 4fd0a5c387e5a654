#include "stats/tails/smirnov.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/stats/table.h"

namespace assay::stats {
namespace {

TEST(Smirnov, GoldenValuesToThePrintedDigits) {
  // lcm(50, 60) = 300
  EXPECT_NEAR(std::exp(smirnov_upper_tail({150, 50, 60}).log_p) / 1.0065070832e-6, 1, 1e-10);
  EXPECT_NEAR(std::exp(smirnov_upper_tail({60, 200, 200}).log_p) / 2.41254989774e-8, 1, 1e-10);
}

TEST(Smirnov, AgreesWithExactCountsOfLatticePaths) {
  for (const tests::Row& row : tests::read_table("smirnov")) {
    const LatticeDistance distance{static_cast<std::uint64_t>(row["steps"]),
                                   static_cast<std::uint64_t>(row["m"]),
                                   static_cast<std::uint64_t>(row["n"])};
    const SmirnovTail tail = smirnov_upper_tail(distance);
    EXPECT_EQ(tail.exactness, Exactness::exact);
    // Relative error of p; near certainty too, as only the upper tail is promised.
    const double expected = row["log_upper"];
    EXPECT_NEAR(tail.log_p, expected, 1e-10 * std::max(1.0, -expected / 690))
        << row["steps"] << " " << row["m"] << " " << row["n"];
  }
}

TEST(Smirnov, LargeEqualSizesAreExactAndNearTheLimitLaw) {
  const std::uint64_t n = 20000000;
  const SmirnovTail tail = smirnov_upper_tail({10000, n, n});
  EXPECT_EQ(tail.exactness, Exactness::exact);
  const double z2 = 1e8 / (2.0 * static_cast<double>(n));
  EXPECT_NEAR(tail.log_p, std::log(2) - 2 * z2, 1e-3);
}

TEST(Smirnov, LargeUnequalSizesSayTheyAreAsymptotic) {
  EXPECT_EQ(smirnov_upper_tail({100000, 20000, 30001}).exactness, Exactness::asymptotic);
}

TEST(Smirnov, ImpossibleAndEmptyDistances) {
  EXPECT_EQ(smirnov_upper_tail({0, 3, 4}).log_p, 0);
  EXPECT_TRUE(std::isfinite(smirnov_upper_tail({13, 3, 4}).log_p));
  EXPECT_THROW(smirnov_upper_tail({1, 0, 4}), std::domain_error);
  EXPECT_THROW(smirnov_upper_tail({1, 1ULL << 40, (1ULL << 40) - 1}), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
