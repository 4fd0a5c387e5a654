#include "stats/planning/looks.h"

#include "stats/means/student_t.h"
#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

constexpr ErrorRates usual{.alpha = .01, .beta = .02, .two_sided = true};

using Sizes = std::vector<std::uint64_t>;

// The ratio is evened out, the last look is the largest sample, and equal sizes are one look.
TEST(Looks, GrowByTheRatioToTheLargestSample) {
  EXPECT_EQ(geometric_sizes({100, 1600}, 2), (Sizes{100, 200, 400, 800, 1600}));
  EXPECT_EQ(geometric_sizes({1000, 30000}, 4), (Sizes{1000, 3107, 9655, 30000}));
  EXPECT_EQ(geometric_sizes({1, 4}, 1.1), (Sizes{1, 2, 3, 4}));
  EXPECT_EQ(geometric_sizes({7, 7}, 2), (Sizes{7}));
}

constexpr LookLaw all_laws[] = {LookLaw::unknown, LookLaw::independent_increments,
                                LookLaw::anytime_valid};

TEST(Looks, OneLookHasAllOfTheErrors) {
  for (const LookLaw law : all_laws) {
    const LookSchedule one = schedule_looks({50}, law, usual);
    EXPECT_EQ(one.alpha, std::vector<double>{.01});
    EXPECT_EQ(one.beta, std::vector<double>{.02});
    EXPECT_EQ(log_p_over_looks(one, std::vector<double>{-3.25}, true), -3.25);
  }
}

TEST(Looks, ShareTheErrorsEvenlyWithoutALawAndNotAtAllIfValidAtAnyTime) {
  const LookSchedule looks = schedule_looks({1, 2, 4, 8}, LookLaw::unknown, usual);
  EXPECT_EQ(looks.alpha, std::vector<double>(4, .0025));
  EXPECT_EQ(looks.beta, std::vector<double>(4, .005));
  const std::vector<double> log_p{std::log(.02), std::log(.005), 0};
  EXPECT_NEAR(std::exp(log_p_over_looks(looks, log_p, true)), .02, 1e-15);
  EXPECT_EQ(log_p_over_looks(looks, std::vector<double>{0, std::log(.5)}, false), 0);
  const LookSchedule anytime = schedule_looks({1, 2, 4}, LookLaw::anytime_valid, usual);
  EXPECT_EQ(anytime.alpha, std::vector<double>(3, .01));
  EXPECT_EQ(anytime.beta, std::vector<double>(3, .02));
  EXPECT_EQ(log_p_over_looks(anytime, log_p, true), std::log(.005));
}

// The constants of tests/tables/boundary.csv.
TEST(Looks, OfIndependentIncrementsHaveWangAndTsiatissBoundary) {
  std::vector<std::uint64_t> sizes;
  for (int k = 0; k < 10; ++k) {
    sizes.push_back(static_cast<std::uint64_t>(std::llround(1e9 * std::exp2((k - 9) / 2.))));
  }
  const LookSchedule looks = schedule_looks(sizes, LookLaw::independent_increments,
                                            {.alpha = .01, .beta = .01, .two_sided = true});
  EXPECT_NEAR(upper_normal_quantile(looks.alpha.back() / 2), 2.679665051, 1e-7);
  EXPECT_NEAR(upper_normal_quantile(looks.beta.back()), 2.452502491, 1e-7);
  EXPECT_NEAR(upper_normal_quantile(looks.beta[5]), 2.452502491 * std::exp2(.5), 1e-7);
}

// At a look's nominal level the p-value is the error over all looks.
TEST(Looks, APValueIsBelowTheErrorExactlyWhereALookRejects) {
  for (const LookLaw law : all_laws) {
    const LookSchedule looks = schedule_looks({40, 60, 100, 131}, law, usual);
    for (std::size_t k = 0; k < looks.count(); ++k) {
      std::vector<double> log_p(k, std::log(.9));
      log_p.push_back(std::log(looks.alpha[k]));
      EXPECT_NEAR(log_p_over_looks(looks, log_p, true), std::log(usual.alpha), 1e-7);
      log_p.back() = std::log(looks.beta[k]);
      EXPECT_NEAR(log_p_over_looks(looks, log_p, false), std::log(usual.beta), 1e-7);
    }
  }
}

TEST(Looks, AProbabilityOfZeroStaysFinite) {
  const double lowest = std::numeric_limits<double>::lowest();
  for (const LookLaw law : all_laws) {
    const LookSchedule looks = schedule_looks({1, 2, 4}, law, usual);
    const double log_p = log_p_over_looks(looks, std::vector<double>{lowest}, true);
    EXPECT_TRUE(std::isfinite(log_p));
    EXPECT_LT(log_p, -1e298);
  }
}

// ln p over the looks of a normal sample's t tests.
double looked_at(Philox& random, const LookSchedule& looks, bool two_sided) {
  Moments x;
  std::vector<double> log_p;
  for (const auto size : looks.sizes) {
    while (x.count < size) x.add(random.normal());
    const TestResult test = student_t(x, {0});
    log_p.push_back(two_sided ? log_p_two_sided(test) : test.log_p_upper);
  }
  return log_p_over_looks(looks, log_p, two_sided);
}

CALIBRATED(Looks, KeepTheLevelOverTenDoublings, 301, 10000, Shape::at_most_uniform) {
  static const auto looks = schedule_looks(geometric_sizes({4, 1024}, 2), LookLaw::unknown, usual);
  return looked_at(random, looks, true);
}

CAUGHT(Looks, TheSmallestOfTheLooksIsCaught, 302, 10000, Shape::at_most_uniform) {
  static const auto looks =
      schedule_looks(geometric_sizes({4, 1024}, 2), LookLaw::anytime_valid, usual);
  return looked_at(random, looks, true);
}

const LookSchedule& with_increments() {
  static const auto looks = schedule_looks(geometric_sizes({50, 800}, std::numbers::sqrt2),
                                           LookLaw::independent_increments, {.two_sided = false});
  return looks;
}

// The smallest of correlated p-values is uniform by their joint law, not only at most so.
CALIBRATED(Looks, OfIndependentIncrementsAreUniform, 303, 5000) {
  return looked_at(random, with_increments(), false);
}

// Independent samples at each look have no such boundary.
CAUGHT(Looks, IncrementsThatDoNotAddUpAreCaught, 304, 5000, Shape::at_most_uniform) {
  std::vector<double> log_p(with_increments().count());
  for (double& each : log_p) each = normal_upper(random.normal());
  return log_p_over_looks(with_increments(), log_p, false);
}

}  // namespace
}  // namespace assay::stats
