#include "stats/cells/chi_square.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/tails/tails.h"
#include "stats/tails/test_result.h"
#include "stats/variances/normal_variances.h"
#include "tests/lehmer.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

void expect_p(double log_p, double expected, double tolerance) {
  EXPECT_NEAR(std::exp(log_p) / expected, 1, tolerance);
}

TEST(Tables, TheWorkedExampleHasItsPrintedDigits) {
  const Moments x = moments_of(golden_x);
  const Moments y = moments_of(golden_y);
  const ContinuousLaw exponential{[](double v) { return -std::expm1(-v); }};
  const TestResult t = student_t(x, {1});
  const TestResult welch = welch_t(x, y, {});
  const TestResult chi = chi_square_variance(x, .3);
  const TestResult f = f_ratio(x, y, 1);
  const OneSampleDistance ks1 = ks_distance(sorted(golden_x), exponential);
  const TwoSampleDistance ks2 = ks_distance(sorted(golden_x), sorted(golden_y));
  const TestResult at_low = welch_t(x, y, {1, -.6});
  const TestResult at_high = welch_t(x, y, {1, .6});
  // At this null value T from s equals the worked example's T from the deviation with denominator
  // n.
  const double null_value = x.mean + .742126210128256 * x.standard_error();
  const struct {
    double found, printed;
  } values[] = {{t.statistic, -.7040427405942026},
                {std::exp(log_p_two_sided(t)), .49921572992616514},
                {t.distribution.parameters.at(0), 9},
                {welch.statistic, -.9297996148556845},
                {std::exp(log_p_two_sided(welch)), .3725950590942638},
                {welch.distribution.parameters.at(0), 10.9076975261363},
                {chi.statistic, 16.8793666666667},
                {std::exp(chi.log_p_upper), .0506389375042817},
                {f.statistic, .612040106637935},
                {std::exp(log_p_two_sided(f)), .487284693225179},
                {ks1.distance, .12303325642225293},
                {std::exp(kolmogorov_smirnov(ks1).log_p_upper), .993117303692647},
                {ks2.distance(), .4},
                {std::exp(kolmogorov_smirnov(ks2).log_p_upper), .433412176059232},
                {std::exp(at_low.log_p_upper), .328841750041338},
                {std::exp(at_high.log_p_lower), .0205575060229084},
                {skewness_corrected_t(x, {null_value}).statistic, -.638855547353991}};
  for (const auto& [found, printed] : values) EXPECT_NEAR(found / printed, 1, 1e-12) << printed;
  EXPECT_EQ(t.distribution.family, "student-t");
  EXPECT_EQ(log_p_equivalence(at_low, at_high), at_low.log_p_upper);
}

TEST(Tables, EveryMethodAgreesWithScipyOnWholeDataSets) {
  for (const Row& row : tests::read_table("tests")) {
    const int k = static_cast<int>(row["k"]);
    SCOPED_TRACE(k);
    const auto xs = tests::table_sample(k, row["n"]);
    const auto ys = tests::table_sample(k + 3, row["m"]);
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

// The cells of make_unequal.R.
std::vector<std::uint64_t> counts_of(const std::vector<double>& values) {
  const std::vector<double> ends{-1, -.25, .5, 1.25};
  std::vector<std::uint64_t> counts(ends.size() + 1);
  for (const double value : values) {
    const auto end = std::lower_bound(ends.begin(), ends.end(), value);
    ++counts[static_cast<std::size_t>(end - ends.begin())];
  }
  return counts;
}

TEST(Tables, SamplesOfUnequalSizesAgreeWithR) {
  for (const Row& row : tests::read_table("unequal")) {
    const double k = row["k"];
    SCOPED_TRACE(k);
    const auto xs = tests::lehmer_sums(1000 * k, static_cast<std::size_t>(row["n"]));
    auto ys = tests::lehmer_sums(1000 * k + 1, static_cast<std::size_t>(row["m"]));
    for (double& y : ys) y = y * row["scale"] + row["shift"];
    const Moments x = moments_of(xs);
    const Moments y = moments_of(ys);
    const TestResult t = student_t(x, {.0625});
    EXPECT_NEAR(t.statistic / row["t"], 1, 1e-9);
    expect_p(log_p_two_sided(t), row["t_p"], 1e-9);
    const TestResult chi = chi_square_variance(x, 1.1);
    EXPECT_NEAR(chi.statistic / row["chi"], 1, 1e-9);
    expect_p(log_p_two_sided(chi), row["chi_p"], 1e-9);
    const TestResult welch = welch_t(x, y, {});
    EXPECT_NEAR(welch.statistic / row["welch"], 1, 1e-9);
    EXPECT_NEAR(welch.distribution.parameters[0] / row["welch_nu"], 1, 1e-9);
    expect_p(log_p_two_sided(welch), row["welch_p"], 1e-9);
    expect_p(welch.log_p_lower, row["welch_less"], 1e-9);
    const TestResult f = f_ratio(x, y, 1);
    EXPECT_NEAR(f.statistic / row["f"], 1, 1e-9);
    expect_p(log_p_two_sided(f), row["f_p"], 1e-9);
    expect_p(f.log_p_upper, row["f_greater"], 1e-9);
    const TestResult ks = kolmogorov_smirnov(ks_distance(tests::sorted(xs), tests::sorted(ys)));
    EXPECT_NEAR(ks.statistic / row["ks"], 1, 1e-12);
    expect_p(ks.log_p_upper, row["ks_p"], 1e-9);
    const ChiSquareTwoSample cells = chi_square_two_sample({counts_of(xs), counts_of(ys)});
    EXPECT_NEAR(cells.test.statistic / row["cells"], 1, 1e-9);
    expect_p(cells.test.log_p_upper, row["cells_p"], 1e-9);
  }
}

// NIST's StRD sets, by the rule they are published with.
std::vector<double> numacc(int set) {
  if (set == 1) return {10000001, 10000003, 10000002};
  const double means[] = {1.2, 1000000.2, 10000000.2};
  const double lows[] = {1.1, 1000000.1, 10000000.1};
  const double highs[] = {1.3, 1000000.3, 10000000.3};
  std::vector<double> values{means[set - 2]};
  for (int i = 0; i < 500; ++i) {
    values.push_back(lows[set - 2]);
    values.push_back(highs[set - 2]);
  }
  return values;
}

// The same in blocks, as the harness takes them.
Moments in_blocks(const std::vector<double>& values, std::size_t size) {
  Moments all;
  for (std::size_t first = 0; first < values.size(); first += size) {
    const std::span<const double> rest = std::span(values).subspan(first);
    all.merge(moments_of(rest.first(std::min(size, rest.size()))));
  }
  return all;
}

TEST(Tables, MeansFarFromZeroAgreeWithFiftyDigits) {
  for (const Row& row : tests::read_table("numacc")) {
    const auto xs = numacc(static_cast<int>(row["set"]));
    const bool two = row["other"] != 0;
    const auto ys = numacc(two ? static_cast<int>(row["other"]) : 1);
    for (const std::size_t block : {std::size_t{10000}, std::size_t{64}, std::size_t{1}}) {
      SCOPED_TRACE(row.text("set") + " " + row.text("other") + " " + row.text("offset") +
                   " in blocks of " + std::to_string(block));
      const Moments x = in_blocks(xs, block);
      const Moments y = in_blocks(ys, block);
      const TestResult result =
          two ? welch_t(x, y, {row["scale"], row["offset"]}) : student_t(x, {row["offset"]});
      EXPECT_NEAR(result.statistic / row["t"], 1, 1e-10);
      EXPECT_NEAR(result.distribution.parameters[0] / row["nu"], 1, 1e-10);
      EXPECT_LT(tests::log_p_error(result.log_p_lower, row["log_lower"]), 1e-10);
      EXPECT_LT(tests::log_p_error(result.log_p_upper, row["log_upper"]), 1e-10);
    }
  }
}

}  // namespace
}  // namespace assay::stats
