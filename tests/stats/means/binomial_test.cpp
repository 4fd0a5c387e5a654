#include "stats/means/binomial.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(Binomial, TailsIncludeTheObservedCount) {
  const TestResult result = binomial({1, 2}, .5);
  EXPECT_NEAR(std::exp(result.log_p_lower), .75, 1e-15);
  EXPECT_NEAR(std::exp(result.log_p_upper), .75, 1e-15);
  EXPECT_EQ(log_p_two_sided(result), 0);
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

}  // namespace
}  // namespace assay::stats
