#include "stats/planning/holm.h"

#include <rapidcheck/gtest.h>

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> log_p_of(const std::vector<std::uint16_t>& numbers) {
  std::vector<double> log_p;
  for (const auto v : numbers) log_p.push_back(std::log((v + 1.0) / 65536.0));
  return log_p;
}

/// With equal weights that sum to 1.
std::vector<double> holm(const std::vector<double>& log_p) {
  std::vector<WeightedLogP> entries;
  for (const double v : log_p) entries.push_back({v, 1.0 / static_cast<double>(log_p.size())});
  return weighted_holm(entries);
}

TEST(Holm, GoldenValuesToThePrintedDigits) {
  const std::vector<double> p{1e-4, .0042, .012, .03, .04, .21, .5};
  const std::vector<double> expected{.0007, .0252, .06, .12, .12, .42, .5};
  std::vector<double> log_p;
  for (const double v : p) log_p.push_back(std::log(v));
  const std::vector<double> adjusted = holm(log_p);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(std::exp(adjusted[i]), expected[i], 1e-12);
}

TEST(Holm, WeightsMoveTheShares) {
  const std::vector<WeightedLogP> entries{{std::log(.01), .9}, {std::log(.01), .1}};
  const std::vector<double> adjusted = weighted_holm(entries);
  EXPECT_NEAR(std::exp(adjusted[0]), .01 / .9, 1e-14);
  EXPECT_NEAR(std::exp(adjusted[1]), std::max(.01 / .9, .01), 1e-14);
  const std::vector<WeightedLogP> half{{std::log(.01), .5}};
  EXPECT_NEAR(std::exp(weighted_holm(half)[0]), .02, 1e-14) << "unspent weight stays unspent";
  EXPECT_TRUE(holm(std::vector<double>{}).empty());
}

RC_GTEST_PROP(Holm, IsMonotoneAndNeverAboveBonferroni,
              (const std::vector<std::uint16_t>& numbers)) {
  const std::vector<double> log_p = log_p_of(numbers);
  const std::vector<double> adjusted = holm(log_p);
  const double m = static_cast<double>(log_p.size());
  for (std::size_t i = 0; i < log_p.size(); ++i) {
    RC_ASSERT(adjusted[i] >= log_p[i] - 1e-12);
    RC_ASSERT(adjusted[i] <= std::min(0.0, log_p[i] + std::log(m)) + 1e-12);
    for (std::size_t j = 0; j < log_p.size(); ++j) {
      if (log_p[i] <= log_p[j]) RC_ASSERT(adjusted[i] <= adjusted[j]);
    }
  }
}

RC_GTEST_PROP(Holm, LoweringOnePValueRaisesNone, (std::vector<std::uint16_t> numbers)) {
  RC_PRE(!numbers.empty());
  const std::vector<double> before = holm(log_p_of(numbers));
  numbers[0] = static_cast<std::uint16_t>(numbers[0] / 2);
  const std::vector<double> after = holm(log_p_of(numbers));
  for (std::size_t i = 0; i < before.size(); ++i) RC_ASSERT(after[i] <= before[i] + 1e-12);
}

}  // namespace
}  // namespace assay::stats
