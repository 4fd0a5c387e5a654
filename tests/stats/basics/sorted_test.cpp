#include "stats/basics/scores.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

void expect_sorted(const std::vector<double>& values) {
  std::vector<double> expected = values;
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(sorted(values), expected) << values.size();
}

// On both sides of a size from which digits are sorted by.
TEST(Sorted, AreTheValuesInTheirOrder) {
  Philox random(990);
  for (const std::size_t size : {0u, 1u, 2u, 511u, 512u, 513u, 5000u}) {
    std::vector<double> values(size);
    for (double& value : values) value = random.uniform() - 0.5;
    expect_sorted(values);
  }
}

TEST(Sorted, OfAllMagnitudesAndSignsAndOfEqualValues) {
  Philox random(991);
  std::vector<double> values(2000);
  for (double& value : values) {
    const double size = std::exp2(std::round(2000 * random.uniform() - 1050));
    value = random.uniform() < 0.5 ? -size : size;
  }
  for (const double end : {0.0, -0.0, 1.0, 1.0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::denorm_min()}) {
    values.push_back(end);
    values.push_back(-end);
  }
  expect_sorted(values);
  expect_sorted(std::vector<double>(1000, 0.25));
}

}  // namespace
}  // namespace assay::stats
