#include "stats/planning/looks.h"

#include "stats/means/student_t.h"
#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

constexpr ErrorRates usual{.alpha = .01, .beta = .02, .two_sided = true};

TEST(Looks, TenDoublingsAreElevenLooks) {
  const std::vector<std::uint64_t> sizes = geometric_sizes({100, 102400}, 2);
  ASSERT_EQ(sizes.size(), 11U);
  for (std::size_t k = 0; k < 11; ++k) EXPECT_EQ(sizes[k], 100U << k);
}

TEST(Looks, TheRatioIsEvenedOutAndTheLastLookIsTheLargestSample) {
  EXPECT_EQ(geometric_sizes({1000, 30000}, 4),
            (std::vector<std::uint64_t>{1000, 3107, 9655, 30000}));
}

TEST(Looks, SmallSizesThatRoundTogetherAreOneLook) {
  EXPECT_EQ(geometric_sizes({1, 4}, 1.1), (std::vector<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_EQ(geometric_sizes({7, 7}, 2), (std::vector<std::uint64_t>{7}));
}

TEST(Looks, OneLookHasAllOfTheErrors) {
  for (const LookLaw law :
       {LookLaw::unknown, LookLaw::independent_increments, LookLaw::anytime_valid}) {
    const LookSchedule one = schedule_looks({50}, law, usual);
    EXPECT_EQ(one.alpha, std::vector<double>{.01});
    EXPECT_EQ(one.beta, std::vector<double>{.02});
    const std::vector<double> log_p{-3.25};
    EXPECT_EQ(log_p_over_looks(one, log_p, true), -3.25);
  }
}

TEST(Looks, WithoutALawTheErrorsAreSplitEvenly) {
  const LookSchedule looks = schedule_looks({1, 2, 4, 8}, LookLaw::unknown, usual);
  EXPECT_EQ(looks.alpha, std::vector<double>(4, .0025));
  EXPECT_EQ(looks.beta, std::vector<double>(4, .005));
  const std::vector<double> log_p{std::log(.02), std::log(.005)};
  EXPECT_NEAR(std::exp(log_p_over_looks(looks, log_p, true)), .02, 1e-15);
  EXPECT_EQ(log_p_over_looks(looks, std::vector<double>{0, std::log(.5)}, false), 0);
}

TEST(Looks, AnytimeValidLooksHaveAllOfTheErrorsEach) {
  const LookSchedule looks = schedule_looks({1, 2, 4}, LookLaw::anytime_valid, usual);
  EXPECT_EQ(looks.alpha, std::vector<double>(3, .01));
  EXPECT_EQ(looks.beta, std::vector<double>(3, .02));
  const std::vector<double> log_p{std::log(.02), std::log(.005), 0};
  EXPECT_EQ(log_p_over_looks(looks, log_p, true), std::log(.005));
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
  for (const LookLaw law :
       {LookLaw::unknown, LookLaw::independent_increments, LookLaw::anytime_valid}) {
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
  for (const LookLaw law :
       {LookLaw::unknown, LookLaw::independent_increments, LookLaw::anytime_valid}) {
    const LookSchedule looks = schedule_looks({1, 2, 4}, law, usual);
    const double log_p = log_p_over_looks(looks, std::vector<double>{lowest}, true);
    EXPECT_TRUE(std::isfinite(log_p));
    EXPECT_LT(log_p, -1e298);
  }
}

TEST(Looks, RefuseWhatCannotKeepTheLevel) {
  EXPECT_THROW(geometric_sizes({0, 4}, 2), std::domain_error);
  EXPECT_THROW(geometric_sizes({5, 4}, 2), std::domain_error);
  EXPECT_THROW(geometric_sizes({1, 4}, 1), std::domain_error);
  EXPECT_THROW(geometric_sizes({1, 4}, std::nan("")), std::domain_error);
  EXPECT_THROW(schedule_looks({}, LookLaw::unknown, usual), std::domain_error);
  EXPECT_THROW(schedule_looks({2, 1}, LookLaw::unknown, usual), std::domain_error);
  EXPECT_THROW(schedule_looks({1}, LookLaw::unknown, {.alpha = 0}), std::domain_error);
  const LookSchedule one = schedule_looks({1}, LookLaw::unknown, usual);
  EXPECT_THROW(log_p_over_looks(one, {}, true), std::domain_error);
  EXPECT_THROW(log_p_over_looks(one, std::vector<double>{-1, -1}, true), std::domain_error);
  EXPECT_THROW(log_p_over_looks(one, std::vector<double>{.1}, true), std::domain_error);
  EXPECT_THROW(log_p_over_looks(one, std::vector<double>{std::nan("")}, true), std::domain_error);
}

// ln p of a normal sample's t tests at each look.
std::vector<double> looked_at(Philox& random, const std::vector<std::uint64_t>& sizes) {
  Moments x;
  std::vector<double> log_p;
  for (const auto size : sizes) {
    while (x.count < size) x.add(random.normal());
    log_p.push_back(log_p_two_sided(student_t(x, {0})));
  }
  return log_p;
}

TEST(Looks, KeepTheLevelOverTenDoublings) {
  const LookSchedule looks = schedule_looks(geometric_sizes({4, 1024}, 2), LookLaw::unknown, usual);
  expect_calibrated(Experiment{301, 10000, Shape::at_most_uniform}, [&](Philox& random) {
    return log_p_over_looks(looks, looked_at(random, looks.sizes), true);
  });
}

// The smallest of correlated p-values is uniform by their joint law, not only at most so.
TEST(Looks, OfIndependentIncrementsAreUniform) {
  const LookSchedule looks = schedule_looks(geometric_sizes({50, 800}, std::numbers::sqrt2),
                                            LookLaw::independent_increments, {.two_sided = false});
  expect_calibrated(Experiment{303, 5000, Shape::uniform}, [&](Philox& random) {
    Moments x;
    std::vector<double> log_p;
    for (const auto size : looks.sizes) {
      while (x.count < size) x.add(random.normal());
      log_p.push_back(student_t(x, {0}).log_p_upper);
    }
    return log_p_over_looks(looks, log_p, false);
  });
}

TEST(Looks, TheSmallestOfTheLooksIsCaught) {
  const LookSchedule looks =
      schedule_looks(geometric_sizes({4, 1024}, 2), LookLaw::anytime_valid, usual);
  expect_caught(Experiment{302, 10000, Shape::at_most_uniform}, [&](Philox& random) {
    return log_p_over_looks(looks, looked_at(random, looks.sizes), true);
  });
}

// Independent samples at each look have no such boundary.
TEST(Looks, IncrementsThatDoNotAddUpAreCaught) {
  const LookSchedule looks = schedule_looks(geometric_sizes({50, 800}, std::numbers::sqrt2),
                                            LookLaw::independent_increments, {.two_sided = false});
  expect_caught(Experiment{304, 5000, Shape::at_most_uniform}, [&](Philox& random) {
    std::vector<double> log_p;
    for (std::size_t k = 0; k < looks.count(); ++k) {
      log_p.push_back(normal_upper(random.normal()));
    }
    return log_p_over_looks(looks, log_p, false);
  });
}

}  // namespace
}  // namespace assay::stats
