#include "stats/basics/moments.h"

#include <rapidcheck/gtest.h>

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// Relative to the natural size of a sum of k-th powers, so that cancelling odd sums are judged
// fairly.
bool close(const Moments& a, const Moments& b) {
  const double n = static_cast<double>(a.count);
  const double sd = a.count > 0 ? std::sqrt(a.m2 / n) : 0;
  const double size = std::max({sd, std::abs(a.mean), 1e-300});
  const auto near = [](double u, double v, double scale) {
    return std::abs(u - v) <= 1e-12 * scale;
  };
  const double spread = std::max(sd, size * 1e-3);
  return a.count == b.count && a.nonzero == b.nonzero && near(a.mean, b.mean, size) &&
         near(a.m2, b.m2, n * spread * spread) &&
         near(a.m3, b.m3, n * std::sqrt(n) * std::pow(spread, 3)) &&
         near(a.m4, b.m4, n * n * std::pow(spread, 4)) &&
         (a.count == 0 || (a.minimum == b.minimum && a.maximum == b.maximum));
}

std::vector<double> values_of(const std::vector<int>& integers) {
  std::vector<double> values;
  for (const int i : integers) values.push_back(static_cast<double>(i) / 7.0);
  return values;
}

TEST(Moments, GoldenValuesToThePrintedDigits) {
  const Moments x = moments_of(golden_x);
  EXPECT_NEAR(x.mean, .833, 1e-14);
  EXPECT_NEAR(x.variance(), .562645555555556, 1e-15);
  EXPECT_NEAR(x.skewness(), .944586223776367, 1e-14);
  EXPECT_NEAR(x.kurtosis(), 2.89302072394759, 1e-13);
  EXPECT_NEAR(moments_of(golden_y).kurtosis(), 3.01597829771009, 1e-13);
  EXPECT_EQ(x.count, 10U);
  EXPECT_EQ(x.minimum, .05);
  EXPECT_EQ(x.maximum, 2.40);
  EXPECT_EQ(x.nonzero, 10U);
  EXPECT_NEAR(x.standard_error(), std::sqrt(.562645555555556 / 10), 1e-15);
}

TEST(Moments, ZeroesAreCountedApart) {
  EXPECT_EQ(moments_of(std::vector<double>{0, 1, 0, -0.0, 2}).nonzero, 2U);
}

// Steps of the mean are far below the spacing of doubles at 1e13. If they are dropped m2 is off by
// 6e-4 and m4 by 1.4e-3.
TEST(Moments, ALargeOffsetOfManyValuesLosesNoStep) {
  tests::Philox random(1801);
  Moments offset;
  Moments distances;
  for (int block = 0; block < 50; ++block) {
    Moments part;
    for (int i = 0; i < 4000; ++i) {
      const double value = 1e13 + random.normal();
      part.add(value);
      distances.add(value - 1e13);
    }
    offset.merge(part);
  }
  EXPECT_NEAR(offset.mean - 1e13 + offset.rest, distances.mean, 1e-12);
  EXPECT_NEAR(offset.m2 / distances.m2, 1, 1e-12);
  EXPECT_NEAR(offset.m3, distances.m3, 1e-12 * distances.m2);
  EXPECT_NEAR(offset.m4 / distances.m4, 1, 1e-12);
}

TEST(Moments, OfAConstantHaveNoVariance) {
  EXPECT_EQ(moments_of(std::vector<double>{2, 2, 2}).variance(), 0);
}

RC_GTEST_PROP(Moments, MergeEqualsOnePass, (const std::vector<int>& a, const std::vector<int>& b)) {
  Moments merged = moments_of(values_of(a));
  merged.merge(moments_of(values_of(b)));
  std::vector<double> all = values_of(a);
  const std::vector<double> rest = values_of(b);
  all.insert(all.end(), rest.begin(), rest.end());
  RC_ASSERT(close(moments_of(all), merged));
}

struct Blocks {
  double offset;
  std::uint64_t size;
  int count;
};

struct Rounded {
  // Error of the mean of one sample.
  double off;
  Moments moments;
};

/// Normal values of deviation 1 around the offset. Their distances from it are exact, and summed
/// without the offset.
Rounded sample(const Blocks& blocks, tests::Philox& random) {
  Moments all;
  Moments distances;
  for (int k = 0; k < blocks.count; ++k) {
    Moments block;
    for (std::uint64_t i = 0; i < blocks.size; ++i) {
      const double value = blocks.offset + random.normal();
      block.add(value);
      distances.add(value - blocks.offset);
    }
    all.merge(block);
  }
  return {(all.mean - blocks.offset) - distances.mean, all};
}

// For a uniform law the root mean square of 200 has a standard deviation of 3.2 %. A fifth more or
// less is six away.
TEST(MeanRounding, IsAsMeasured) {
  tests::Philox random(1717);
  for (const Blocks& blocks : {Blocks{1e8, 256, 1}, Blocks{1e10, 256, 16}, Blocks{1e12, 1024, 1},
                               Blocks{1e13, 64, 64}, Blocks{1e14, 1024, 32}}) {
    double squares = 0, expected = 0;
    for (int run = 0; run < 200; ++run) {
      const Rounded rounded = sample(blocks, random);
      squares += rounded.off * rounded.off / 200;
      expected = rounding_of_mean(rounded.moments);
    }
    EXPECT_GT(std::sqrt(squares), expected * 0.8) << blocks.offset << " " << blocks.size;
    EXPECT_LT(std::sqrt(squares), expected * 1.2) << blocks.offset << " " << blocks.size;
  }
}

TEST(MeanRounding, OfValuesThatDoNotVaryIsNone) {
  Moments constant;
  for (int i = 0; i < 10; ++i) constant.add(1e15);
  EXPECT_EQ(rounding_of_mean(constant), 0);
  EXPECT_EQ(rounding_of_mean({}), 0);
}

}  // namespace
}  // namespace assay::stats
