#include "stats/means/binomial.h"

#include "stats/tails/tails.h"
#include "tests/prelude.h"

namespace assay::stats {
namespace {

TEST(Binomial, TailsIncludeTheObservedCount) {
  const TestResult result = binomial({1, 2}, .5);
  EXPECT_NEAR(std::exp(result.log_p_lower), .75, 1e-15);
  EXPECT_NEAR(std::exp(result.log_p_upper), .75, 1e-15);
  EXPECT_EQ(log_p_two_sided(result), 0);
}

TEST(Binomial, NoHitInAThousandAtOneInAMillion) {
  // Two-sided 1e-6: (1 - p)^1000 = 5e-7 at p = .0144.
  const double bound = -std::expm1(std::log(5e-7) / 1000);
  EXPECT_NEAR(binomial({0, 1000}, bound).log_p_lower, std::log(5e-7), 1e-10);
}

TEST(Binomial, ClopperPearsonEndsAreJustRejected) {
  for (const std::uint64_t k : {1ULL, 7ULL, 59ULL}) {
    const Interval interval = clopper_pearson({k, 60}, .99);
    EXPECT_NEAR(std::exp(binomial({k, 60}, interval.low).log_p_upper), .005, 1e-11);
    EXPECT_NEAR(std::exp(binomial({k, 60}, interval.high).log_p_lower), .005, 1e-11);
  }
  EXPECT_EQ(clopper_pearson({0, 60}, .99).low, 0);
  EXPECT_EQ(clopper_pearson({60, 60}, .99).high, 1);
  EXPECT_NEAR(clopper_pearson({0, 60}, .99).high, 1 - std::pow(.005, 1 / 60.0), 1e-12);
}

TEST(Binomial, CertainAndImpossibleNullProbabilities) {
  EXPECT_TRUE(std::isfinite(binomial({3, 10}, 0).log_p_upper));
  EXPECT_LT(binomial({3, 10}, 0).log_p_upper, -1e300);
  EXPECT_EQ(binomial({0, 10}, 0).log_p_upper, 0);
  EXPECT_EQ(binomial({10, 10}, 1).log_p_lower, 0);
}

TEST(Binomial, BadArgumentsThrow) {
  EXPECT_THROW(binomial({0, 0}, .5), std::domain_error);
  EXPECT_THROW(binomial({3, 2}, .5), std::domain_error);
  EXPECT_THROW(binomial({1, 2}, 1.5), std::domain_error);
  EXPECT_THROW(clopper_pearson({1, 2}, 1), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
