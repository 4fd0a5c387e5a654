#include "stats/basics/joint_moments.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

/// Deviations from the mean in 64-bit mantissas, of values less the first, which is exact.
std::vector<long double> deviations(const std::vector<double>& values) {
  long double sum = 0;
  for (const double value : values) sum += static_cast<long double>(value) - values[0];
  const long double mean = sum / static_cast<long double>(values.size());
  std::vector<long double> result;
  for (const double value : values) {
    result.push_back(static_cast<long double>(value) - values[0] - mean);
  }
  return result;
}

/// Two passes, far from the code under test.
long double brute(const Pairs& pairs, std::size_t i, std::size_t j, bool absolute) {
  const std::vector<long double> d = deviations(pairs.x);
  const std::vector<long double> e = deviations(pairs.cost);
  long double sum = 0;
  for (std::size_t k = 0; k < d.size(); ++k) {
    const long double term =
        std::pow(d[k], static_cast<int>(i)) * std::pow(e[k], static_cast<int>(j));
    sum += absolute ? std::abs(term) : term;
  }
  return sum;
}

void expect_sums(const Pairs& pairs, const JointMoments& found, double tolerance) {
  for (std::size_t j = 0; 2 * j <= JointMoments::weight; ++j) {
    for (std::size_t i = 0; i + 2 * j <= JointMoments::weight; ++i) {
      const auto error = std::abs(found.sum(i, j) - brute(pairs, i, j, false));
      EXPECT_LE(error, tolerance * brute(pairs, i, j, true)) << i << " " << j;
    }
  }
}

/// Pairs of a skewed and a heavy law, with costs that follow the square.
Pairs drawn(std::size_t count, double offset, double unit = 1) {
  Philox random(901);
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = random.normal();
    const double value = i % 3 == 0 ? std::exp(z) : random.exponential();
    pairs.x.push_back(offset + unit * value);
    pairs.cost.push_back(offset / 2 + 3 + std::floor(4 * random.uniform()) + z * z);
  }
  return pairs;
}

TEST(JointMoments, AgreeWithTwoPassesInLongDoubles) {
  for (const std::size_t count : {2UL, 9UL, 255UL, 256UL, 257UL, 3000UL}) {
    const Pairs pairs = drawn(count, 0);
    expect_sums(pairs, joint(pairs), 2e-14);
  }
}

// Values near 1e8 with spread 1 have eight digits after the point: nothing else is lost.
TEST(JointMoments, FarFromZeroLoseNothing) {
  const Pairs pairs = drawn(5000, 1e8);
  expect_sums(pairs, joint(pairs), 1e-13);
  const Pairs small = drawn(5000, 1, 1e-7);
  expect_sums(small, joint(small), 1e-13);
}

TEST(JointMoments, MergedPartsEqualOnePass) {
  const Pairs pairs = drawn(1000, 40);
  for (const std::size_t cut : {0UL, 1UL, 37UL, 256UL, 700UL, 1000UL}) {
    JointSums left;
    JointSums right;
    for (std::size_t i = 0; i < 1000; ++i) (i < cut ? left : right).add(pairs.x[i], pairs.cost[i]);
    left.merge(right);
    EXPECT_EQ(left.moments().count, 1000U);
    expect_sums(pairs, left.moments(), 1e-13);
  }
}

// A look counts what waits, and changes nothing.
TEST(JointMoments, ALookOnTheWayLeavesNoTrace) {
  const Pairs pairs = drawn(700, 1);
  JointSums looked;
  JointSums plain;
  for (std::size_t i = 0; i < 700; ++i) {
    looked.add(pairs.x[i], pairs.cost[i]);
    plain.add(pairs.x[i], pairs.cost[i]);
    EXPECT_EQ(looked.moments().count, i + 1);
  }
  EXPECT_EQ(looked.moments(), plain.moments());
}

TEST(JointMoments, AConstantCostLeavesExactZeros) {
  JointSums sums;
  const Pairs pairs = drawn(1000, 0);
  for (const double x : pairs.x) sums.add(x, 3.3);
  const JointMoments moments = sums.moments();
  for (std::size_t j = 1; 2 * j <= JointMoments::weight; ++j) {
    for (std::size_t i = 0; i + 2 * j <= JointMoments::weight; ++i) EXPECT_EQ(moments.sum(i, j), 0);
  }
  EXPECT_EQ(moments.cost().mean, 3.3);
}

TEST(JointMoments, HoldTheMomentsOfEachCoordinate) {
  const Pairs pairs = drawn(1000, 7);
  const Moments x = moments_of(pairs.x);
  const Moments cost = moments_of(pairs.cost);
  const JointMoments both = joint(pairs);
  EXPECT_NEAR(both.x().mean, x.mean, 1e-14);
  EXPECT_NEAR(both.x().kurtosis() / x.kurtosis(), 1, 1e-12);
  EXPECT_NEAR(both.cost().skewness() / cost.skewness(), 1, 1e-12);
  EXPECT_EQ(both.x().maximum, x.maximum);
  EXPECT_EQ(both.cost().minimum, cost.minimum);
}

TEST(JointMoments, OfFourMomentsAreTheLowestSums) {
  const Moments x = moments_of(drawn(50, 0).x);
  const JointMoments four = joint_of_four(x, 2);
  EXPECT_EQ(four.known, 4U);
  EXPECT_EQ(four.x().m3, x.m3);
  EXPECT_EQ(four.x().m4, x.m4);
  EXPECT_EQ(four.cost().mean, 2);
}

}  // namespace
}  // namespace assay::stats
