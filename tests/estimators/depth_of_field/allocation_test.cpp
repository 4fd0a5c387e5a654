// Counts of lens samples against an independent table, and what they must keep to.

#include "depth_of_field/exact.h"
#include "depth_of_field/image.h"
#include "tests/estimators/table.h"

namespace assay::depth_of_field {
namespace {

using Counts = std::vector<std::uint64_t>;

double total(const Counts& counts) {
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
}

/// Variances of a row of pixels across the edge of the scene `edge`.
std::vector<double> across_edge(std::size_t width, double size) {
  std::vector<double> out;
  for (std::size_t i = 0; i < width; ++i) {
    const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(width) - 0.5;
    const double c = half_plane_coverage(-x * size / 0.2);
    out.push_back(c * (1 - c));
  }
  return out;
}

TEST(LensCounts, AreThoseOfAnIndependentSearch) {
  for (const auto& row : tests::table("lens_counts.csv")) {
    const std::vector<double> variances = across_edge(std::stoul(row[0]), std::stod(row[1]));
    std::istringstream stream(row[8]);
    Counts expected;
    for (std::uint64_t n = 0; stream >> n;) expected.push_back(n);
    EXPECT_EQ(lens_counts(variances, {std::stod(row[2])}), expected) << row[0];
  }
}

TEST(LensCounts, KeepToTheBudgetAndLeaveLessThanOneMoreEach) {
  const std::vector<double> variances = across_edge(37, 1.3);
  for (const double exponent : {0.5, 2. / 3, 1.}) {
    for (const double mean : {1., 3., 17., 200.}) {
      const Counts counts = lens_counts(variances, {mean, exponent});
      EXPECT_LE(total(counts), mean * 37);
      // A little more K adds one to some pixel: both halves of a mirrored row at once.
      EXPECT_GT(total(counts), mean * 37 - 3) << mean << ' ' << exponent;
    }
  }
}

// Four times the variance: 4, 4^(2/3) = 2.52 and 2 times the samples, or the same number.
TEST(LensCounts, GoWithThePowerOfTheVariance) {
  const std::vector<double> variances{1, 4};
  EXPECT_EQ(lens_counts(variances, {50, 1}), (Counts{20, 80}));
  EXPECT_EQ(lens_counts(variances, {50, 2. / 3}), (Counts{28, 72}));
  EXPECT_EQ(lens_counts(variances, {60, 0.5}), (Counts{40, 80}));
  EXPECT_EQ(lens_counts(variances, {50, 0}), (Counts{50, 50}));
}

// Exponent 1 makes V / N equal. With 1/2 the sum of V / N is (sum of sqrt V)^2 / the budget, the
// least there is (Neyman 1934). Counts near 1000 are rounded.
TEST(LensCounts, EqualiseTheNoiseOrMinimiseItsSum) {
  const std::vector<double> variances{0.3, 1.7, 5, 0.9};
  const Counts equal = lens_counts(variances, {1000, 1});
  const Counts least = lens_counts(variances, {1000, 0.5});
  const double sum = 7.9;
  const double roots = std::sqrt(0.3) + std::sqrt(1.7) + std::sqrt(5.) + std::sqrt(0.9);
  double of_least = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(variances[i] / static_cast<double>(equal[i]), sum / 4000, 0.004 * sum / 4000);
    of_least += variances[i] / static_cast<double>(least[i]);
  }
  EXPECT_NEAR(of_least, roots * roots / 4000, 1e-5 * of_least);
}

TEST(LensCounts, LeaveOneSampleWhereThereIsNoVariance) {
  EXPECT_EQ(lens_counts(std::vector<double>{0, 0, 0}, {9, 1}), (Counts{1, 1, 1}));
  EXPECT_EQ(lens_counts(std::vector<double>{0, 2, 0, 2}, {9, 1}), (Counts{1, 17, 1, 17}));
  EXPECT_EQ(lens_counts(std::vector<double>{0, 0, 0}, {9, 0}), (Counts{9, 9, 9}));
}

}  // namespace
}  // namespace assay::depth_of_field
