#include "stats/gates/copies.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> uniform_values(std::size_t n, std::uint32_t stream) {
  Philox random(stream);
  return sample_of(n, [&] { return random.uniform(); });
}

std::vector<double> joined(std::vector<double> values, const std::vector<double>& more) {
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

void expect_run(const std::optional<RepeatedRun>& run, std::size_t first, std::size_t second,
                std::size_t length) {
  ASSERT_TRUE(run);
  EXPECT_EQ(run->first, first);
  EXPECT_EQ(run->second, second);
  EXPECT_EQ(run->length, length);
}

TEST(RepeatedRun, FindsBlocksThatOccurAgainWholly) {
  const std::vector<double> block = uniform_values(100, 1);
  std::vector<double> values = block;
  for (int i = 1; i < 10; ++i) values = joined(values, block);
  expect_run(repeated_run(values), 0, 100, 900);
}

TEST(RepeatedRun, FindsTheSecondOfTwoFarApart) {
  const std::vector<double> block = uniform_values(60, 2);
  const auto values = joined(joined(joined(uniform_values(37, 3), block), uniform_values(500, 4)),
                             joined(block, uniform_values(11, 5)));
  expect_run(repeated_run(values), 37, 597, 60);
}

// 4 values over and over, which 60 draws from four values would not give.
TEST(RepeatedRun, FindsAShortPatternThatGoesOn) {
  std::vector<double> values;
  for (int i = 0; i < 60; ++i) values.push_back(std::sqrt(1 + i % 4));
  const auto run = repeated_run(values);
  ASSERT_TRUE(run);
  expect_run(run, run->first, run->first + 4, 56);
}

TEST(RepeatedRun, NeedsAsManyChangesAsChanceDoesNotMake) {
  // log2(100^2 / 1e-5) = 29.9: 31 values have the 30 changes, 29 have not.
  for (const std::size_t length : {29u, 31u}) {
    const auto block = uniform_values(length, 6);
    const auto one = joined(block, uniform_values(100 - length, 7));
    const auto two = joined(uniform_values(100 - length, 8), block);
    EXPECT_EQ(common_run(one, two).has_value(), length == 31) << length;
  }
}

TEST(RepeatedRun, OfTwoSamplesSaysWhereInEach) {
  const auto block = uniform_values(50, 9);
  const auto one = joined(block, uniform_values(20, 10));
  expect_run(common_run(one, joined(uniform_values(30, 11), block)), 0, 30, 50);
  EXPECT_FALSE(common_run(uniform_values(1000, 12), uniform_values(1000, 13)));
}

// Laws of few values repeat runs soonest. The header's bound is 0.016 for all samples together.
// With three equal values a change matches with probability 1/4 for each before it. Chance is below
// 1e-13, less for the others.
TEST(RepeatedRun, IsNotFoundInIndependentValues) {
  Philox random(14);
  const auto coin = [&] { return std::floor(2 * random.uniform()); };
  const auto die = [&] { return std::floor(3 * random.uniform()); };
  const auto spike = [&] { return random.uniform() < 0.02 ? std::floor(3 * random.uniform()) : 5; };
  const auto hundredths = [&] { return std::round(100 * random.uniform()) / 100; };
  for (int i = 0; i < 400; ++i) {
    EXPECT_FALSE(repeated_run(sample_of(2000, coin)));
    EXPECT_FALSE(repeated_run(sample_of(2000, die)));
    EXPECT_FALSE(repeated_run(sample_of(2000, spike)));
    EXPECT_FALSE(repeated_run(sample_of(2000, hundredths)));
  }
}

// Runs of the common value have many lengths, between two rare values that have few.
TEST(RepeatedRun, StaysOfDifferentLengthsDiffer) {
  Philox random(16);
  const auto rare = [&] {
    const double u = random.uniform();
    return u < 0.9 ? 0.0 : u < 0.998 ? 1.0 : 2.0;
  };
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(repeated_run(sample_of(20000, rare)));
}

// The stays of two states that change at nearly every step are short and alike.
TEST(RepeatedRun, IsNotFoundInChains) {
  Philox random(15);
  double place = 0;
  const auto walk = [&] { return place += random.uniform() < 0.5 ? -1 : 1; };
  const auto lazy = [&] { return random.uniform() < 0.9 ? place : walk(); };
  const auto two_states = [&](double change) {
    return [&, change] { return place = random.uniform() < change ? 1 - place : place; };
  };
  EXPECT_FALSE(repeated_run(sample_of(20000, walk)));
  EXPECT_FALSE(repeated_run(sample_of(20000, lazy)));
  place = 0;
  EXPECT_FALSE(repeated_run(sample_of(20000, two_states(0.05))));
  EXPECT_FALSE(repeated_run(sample_of(4000, two_states(0.97))));
  EXPECT_FALSE(repeated_run(std::vector<double>(1000, 0.25)));
  EXPECT_FALSE(repeated_run({}));
}

}  // namespace
}  // namespace assay::stats
