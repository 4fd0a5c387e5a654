#include "stats/tails/kolmogorov.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(Smirnov, AgreesWithExactCountsOfLatticePaths) {
  for (const tests::Row& row : tests::read_table("smirnov")) {
    const LatticeDistance distance{static_cast<std::uint64_t>(row["steps"]),
                                   static_cast<std::uint64_t>(row["m"]),
                                   static_cast<std::uint64_t>(row["n"])};
    // Relative error of p; near certainty too, as only the upper tail is promised.
    const double expected = row["log_upper"];
    EXPECT_NEAR(smirnov_upper_tail(distance), expected, 1e-10 * std::max(1.0, -expected / 690))
        << row["steps"] << " " << row["m"] << " " << row["n"];
  }
}

TEST(Smirnov, LargeEqualSizesAreExactAndNearTheLimitLaw) {
  const std::uint64_t n = 20000000;
  const double z2 = 1e8 / (2.0 * static_cast<double>(n));
  EXPECT_NEAR(smirnov_upper_tail({10000, n, n}), std::log(2) - 2 * z2, 1e-3);
}

// Every order of m values of x among n of y, at the ends of runs.
double enumerated(const LatticeDistance& distance, const std::vector<TiedRun>& ties) {
  const std::uint64_t total = distance.m + distance.n;
  const auto steps = [&](std::uint64_t of, std::uint64_t size) {
    return static_cast<double>(of) / static_cast<double>(size);
  };
  double orders = 0;
  double touching = 0;
  for (std::uint64_t bits = 0; bits < (1ULL << total); ++bits) {
    if (static_cast<std::uint64_t>(std::popcount(bits)) != distance.m) continue;
    ++orders;
    bool touches = false;
    for (std::uint64_t k = 1; k <= total; ++k) {
      const bool inside = std::any_of(ties.begin(), ties.end(), [&](const TiedRun& run) {
        return run.before < k && k < run.before + run.size;
      });
      const auto x = static_cast<std::uint64_t>(std::popcount(bits & ((1ULL << k) - 1)));
      const double gap = std::abs(steps(x, distance.m) - steps(k - x, distance.n));
      touches = touches || (!inside && gap > distance.value() - 1e-9);
    }
    touching += touches;
  }
  return touching / orders;
}

TEST(Smirnov, GivenTiesIsTheShareOfAllOrders) {
  const std::vector<TiedRun> some{{0, 3}, {4, 2}, {9, 4}};
  const std::vector<TiedRun> all{{0, 13}};
  for (std::uint64_t steps = 1; steps <= 42; ++steps) {
    for (const auto& ties : {std::vector<TiedRun>{}, some, all}) {
      const LatticeDistance distance{steps, 6, 7};
      const double p = std::exp(smirnov_upper_tail(distance, ties));
      EXPECT_NEAR(p, enumerated(distance, ties), 1e-14) << steps;
    }
    const LatticeDistance even{steps % 6 + 1, 6, 6};
    EXPECT_NEAR(std::exp(smirnov_upper_tail(even, std::vector<TiedRun>{{2, 5}})),
                enumerated(even, {{2, 5}}), 1e-14);
  }
}

TEST(Smirnov, BeyondTheExactCountTiesAreBoundedFromAbove) {
  const std::uint64_t n = 40000;
  const std::vector<TiedRun> half{{0, n}};
  EXPECT_EQ(smirnov_upper_tail({400, n, n}, half), smirnov_upper_tail({400, n, n}));
  const double exact = smirnov_upper_tail({100, n / 4, n / 4}, std::vector<TiedRun>{{0, n / 4}});
  EXPECT_LT(exact, smirnov_upper_tail({100, n / 4, n / 4}));
}

TEST(Smirnov, OnlyLargeUnequalSizesTakeTheLimitLaw) {
  const auto limit = [](const LatticeDistance& distance, double m, double n) {
    return log_kolmogorov_limit(std::sqrt(m / (m + n) * n) * distance.value());
  };
  const LatticeDistance small{10000000, 20000, 30001};
  EXPECT_NE(smirnov_upper_tail(small), limit(small, 20000, 30001));
  const LatticeDistance large{300000000, 200000, 300001};
  EXPECT_EQ(smirnov_upper_tail(large), limit(large, 200000, 300001));
  EXPECT_NEAR(smirnov_upper_tail(large), std::log(2) - 2 * 3e8 * 3e8 / 200000 / 300001 / 500001,
              1e-6);
}

TEST(Smirnov, ImpossibleAndEmptyDistances) {
  EXPECT_EQ(smirnov_upper_tail({0, 3, 4}), 0);
  EXPECT_TRUE(std::isfinite(smirnov_upper_tail({13, 3, 4})));
}

// tests/tables/suprema.csv is the convolution itself, by quadrature; the grid may only add to it.
TEST(SupremumBound, IsTheConvolutionOfTheTwoLawsWhicheverIsLarger) {
  for (const tests::Row& row : tests::read_table("suprema")) {
    const TwoSizes sizes{static_cast<std::uint64_t>(row["m"]),
                         static_cast<std::uint64_t>(row["n"])};
    const double bound = log_two_suprema_bound(row["gap"], sizes);
    EXPECT_GE(bound, row["log_p"] - 1e-9) << row.text("m") << " and " << row.text("n");
    EXPECT_LE(bound, row["log_p"] + 0.03) << row.text("m") << " and " << row.text("n");
  }
}

TEST(SupremumBound, OfNoGapIsOne) { EXPECT_EQ(log_two_suprema_bound(0, {10, 20}), 0); }

}  // namespace
}  // namespace assay::stats
