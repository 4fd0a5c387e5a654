#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/chi_square_variance.h"
#include "stats/f_ratio.h"
#include "stats/kolmogorov_smirnov.h"
#include "stats/student_t.h"
#include "stats/tails.h"
#include "stats/welch_t.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::moments_of;
using tests::Row;

// The data sets of make_tables.py, tests_rows.
std::vector<double> sample(int k, int size) {
  std::vector<double> values;
  for (int i = 1; i <= size; ++i) {
    const double tooth = 1 + std::fmod(0.05 * k * i, 3);
    values.push_back(std::cos(i * (0.7 + 0.1 * k)) * tooth + 0.01 * k * i + 0.3 * k);
  }
  return values;
}

void expect_p(double log_p, double expected, double tolerance) {
  EXPECT_NEAR(std::exp(log_p) / expected, 1, tolerance);
}

TEST(Tables, EveryMethodAgreesWithScipyOnWholeDataSets) {
  for (const Row& row : tests::read_table("tests")) {
    const int k = static_cast<int>(row["k"]);
    SCOPED_TRACE(k);
    const auto xs = sample(k, static_cast<int>(row["n"]));
    const auto ys = sample(k + 3, static_cast<int>(row["m"]));
    const Moments x = moments_of(xs);
    const Moments y = moments_of(ys);
    const TestResult t = student_t(x, {0.2 * k});
    EXPECT_NEAR(t.statistic / row["t"], 1, 1e-10);
    expect_p(log_p_two_sided(t), row["t_two_sided"], 1e-10);
    const TestResult welch = welch_t(x, y, {});
    EXPECT_NEAR(welch.statistic / row["welch"], 1, 1e-10);
    expect_p(log_p_two_sided(welch), row["welch_two_sided"], 1e-10);
    expect_p(welch.log_p_lower, row["welch_less"], 1e-10);
    expect_p(welch.log_p_upper, row["welch_greater"], 1e-10);
    const TestResult chi = chi_square_variance(x, 0.4 + 0.1 * k);
    expect_p(chi.log_p_upper, row["chi_upper"], 1e-10);
    expect_p(chi.log_p_lower, row["chi_lower"], 1e-10);
    const TestResult f = f_ratio(x, y, 1);
    expect_p(f.log_p_upper, row["f_upper"], 1e-10);
    expect_p(f.log_p_lower, row["f_lower"], 1e-10);
    const auto law = [&](double v) { return std::exp(normal_tails((v - 0.3 * k) / 1.2).lower); };
    const TestResult ks1 = kolmogorov_smirnov(ks_distance(tests::sorted(xs), {law}));
    EXPECT_NEAR(ks1.statistic, row["ks1"], 1e-12);
    expect_p(ks1.log_p_upper, row["ks1_p"], 1e-8);
    const TestResult ks2 = kolmogorov_smirnov(ks_distance(tests::sorted(xs), tests::sorted(ys)));
    EXPECT_NEAR(ks2.statistic, row["ks2"], 1e-12);
    expect_p(ks2.log_p_upper, row["ks2_p"], 1e-10);
  }
}

}  // namespace
}  // namespace assay::stats
