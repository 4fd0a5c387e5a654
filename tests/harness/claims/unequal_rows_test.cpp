// Two recorded files of unequal length: every row of both is tested.

#include <fmt/format.h>

#include "harness/command/commands.h"
#include "reports/report_formats.h"
#include "stats/variances/influence.h"
#include "tests/harness/prelude.h"
#include "tests/harness/recorded_rows.h"
#include "tests/lehmer.h"
#include "tests/stats/table.h"

namespace assay::harness {
namespace {

struct Rows {
  std::vector<double> a, b;
};

reports::Suite judged(const Workplace& place, const Rows& rows, const std::string& tests) {
  return compared(place, rows.a, rows.b, tests);
}

std::vector<std::uint64_t> sizes_of(const reports::Test& test) {
  std::vector<std::uint64_t> sizes;
  for (const reports::Sample& sample : test.samples) sizes.push_back(sample.secondaries);
  return sizes;
}

Rows lehmer_rows(double k, std::size_t n, std::size_t m) {
  return {tests::lehmer_sums(1000 * k, n), tests::lehmer_sums(1000 * k + 1, m)};
}

using Sizes = std::vector<std::uint64_t>;

using UnequalRows = Placed;

TEST_F(UnequalRows, AgreeWithRFromFilesToTheRecord) {
  for (const tests::Row& row : tests::read_table("unequal")) {
    SCOPED_TRACE(row.text("k"));
    const Sizes sizes{static_cast<std::uint64_t>(row["n"]), static_cast<std::uint64_t>(row["m"])};
    Rows rows = lehmer_rows(row["k"], sizes[0], sizes[1]);
    for (double& y : rows.b) y = y * row["scale"] + row["shift"];
    const Workplace folder;
    const reports::Suite suite =
        judged(folder, rows,
               "  - {claim: mean(a) == mean(b), test: welch}\n"
               "  - {claim: variance(a) == variance(b), test: F}\n"
               "  - {claim: distribution(a) == distribution(b), test: ks}\n"
               "  - {claim: mean(a) == 0.0625, test: t}\n"
               "  - {claim: variance(a) == 1.1, test: chi-square}\n");
    const char* const columns[] = {"welch", "f", "ks", "t", "chi"};
    for (std::size_t i = 0; i < suite.tests.size(); ++i) {
      const reports::Test& test = suite.tests[i];
      SCOPED_TRACE(test.claim);
      const reports::Channel& channel = test.channels.at(0);
      EXPECT_NEAR(*channel.statistic / row[columns[i]], 1, 1e-9);
      EXPECT_NEAR(*channel.p_value / row[std::string(columns[i]) + "_p"], 1, 1e-9);
      EXPECT_EQ(sizes_of(test), i < 3 ? sizes : Sizes{sizes[0]});
    }
  }
}

TEST_F(UnequalRows, OfVariancesAreEachWeighedByTheirNumber) {
  const Rows rows = lehmer_rows(7, 4000, 2900);
  const reports::Suite suite = judged(place, rows,
                                      "  - {claim: variance(a) == variance(b)}\n"
                                      "  - {claim: total_variance(a) == total_variance(b)}\n"
                                      "  - {claim: efficiency(a) == efficiency(b), cost: samples}\n"
                                      "  - {claim: variance(a) within 40% of variance(b)}\n");
  for (const reports::Test& test : suite.tests) {
    EXPECT_EQ(test.verdict, Verdict::pass) << test.claim << ": " << test.message;
    EXPECT_EQ(sizes_of(test), (Sizes{4000, 2900}));
  }
  EXPECT_EQ(suite.tests[0].method, "influence-t");
  const auto influence = [](const std::vector<double>& values) {
    stats::JointSums sums;
    for (const double value : values) sums.add(value, 0);
    return stats::influence_of_variance(sums.moments());
  };
  const stats::TestResult expected = stats::influence_t(influence(rows.a), influence(rows.b), 0);
  EXPECT_NEAR(*suite.tests[0].channels.at(0).statistic, expected.statistic, 1e-9);
}

TEST_F(UnequalRows, AreCappedByNumberAndBudget) {
  const Rows rows = lehmer_rows(4, 400, 250);
  const reports::Suite suite =
      judged(place, rows,
             "  - {name: aaa, claim: mean(a) == mean(b), secondaries: 300}\n"
             "  - {name: bbb, claim: mean(a) == mean(b), secondaries: 120}\n"
             "  - {name: ccc, claim: mean(a) == mean(b), budget: 620}\n"
             "  - {name: ddd, claim: mean(a) == mean(b), budget: 10000}\n"
             "  - {claim: mean(a) == mean(drawn)}\n");
  const Sizes expected[] = {{300, 250}, {120, 120}, {370, 250}, {400, 250}, {400, 400}};
  for (std::size_t i = 0; i < suite.tests.size(); ++i) {
    EXPECT_EQ(sizes_of(suite.tests[i]), expected[i]) << i;
  }
  EXPECT_THAT(
      refusal([&] { judged(place, rows, "  - {claim: mean(a) == mean(b), secondaries: 401}\n"); }),
      HasSubstr("`secondaries: 401` is more than the 400 observations that `a` has"));
}

TEST_F(UnequalRows, FindAsMuchWhicheverSideIsLonger) {
  const Rows rows = lehmer_rows(5, 400, 250);
  const std::string tests =
      "  - {claim: mean(a) == mean(b), detect: 0.5}\n"
      "  - {claim: variance(a) == variance(b), test: F, detect: 50%}\n"
      "  - {claim: distribution(a) == distribution(b), test: ks, detect: 0.2}\n"
      "  - {claim: mean(a) within 0.4 of mean(b)}\n";
  const reports::Suite one = judged(place, rows, tests);
  const reports::Suite other = judged(place, {rows.b, rows.a}, tests);
  const reports::Suite shorter =
      judged(place, {{rows.a.begin(), rows.a.begin() + 250}, rows.b}, tests);
  for (std::size_t i = 0; i < one.tests.size(); ++i) {
    EXPECT_NEAR(*one.tests[i].power, *other.tests[i].power, 1e-9) << i;
    EXPECT_GT(*one.tests[i].power, *shorter.tests[i].power) << i;
  }
}

TEST_F(UnequalRows, SayHowManyOfEachWouldDecide) {
  const reports::Suite suite =
      judged(place, lehmer_rows(6, 400, 240), "  - {claim: mean(a) == mean(b), detect: 0.01}\n");
  EXPECT_EQ(suite.tests[0].verdict, Verdict::inconclusive);
  EXPECT_THAT(suite.tests[0].advice.value().words,
              testing::MatchesRegex("give about [0-9.,k]+M? and [0-9.,k]+M? rows"));
}

TEST_F(UnequalRows, AreReplayedWhileTheyAreAsManyAsTheyWere) {
  const Rows rows = lehmer_rows(2, 400, 250);
  judged(place, rows, "  - {name: two, claim: mean(a) == mean(b)}\n");
  const reports::Record record = run_files({place.file("suite.yaml")}, repeatable);
  const std::string file = place.write("run.json", reports::json(record));
  const auto replayed = [&] {
    return said_by([&] { return replay({.record = file, .test = "two"}); });
  };
  EXPECT_EQ(replayed().code, 0);
  for (const std::size_t count : {249U, 251U}) {
    place.write("b.txt", file_of(tests::lehmer_sums(2001, count)));
    const Said said = replayed();
    EXPECT_EQ(said.code, 1);
    EXPECT_THAT(said.text,
                HasSubstr(fmt::format("{:<27} {}   (recorded: 250", "secondaries", count)));
  }
}

/// The values in the order of their keys.
std::vector<double> in_order_of(const std::vector<double>& keys,
                                const std::vector<double>& values) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t i = 0; i < values.size(); ++i) pairs.emplace_back(keys[i], values[i]);
  std::ranges::sort(pairs);
  std::vector<double> ordered;
  for (const auto& pair : pairs) ordered.push_back(pair.second);
  return ordered;
}

// The mean is known to half its last digit alone, which is 3e-7 of the difference.
TEST_F(UnequalRows, OfALargeMeanLoseNoDigitOfIt) {
  Rows rows{{10000000.2}, {1000000.2}};
  for (int i = 0; i < 500; ++i) {
    rows.a.insert(rows.a.end(), {10000000.1, 10000000.3});
    rows.b.insert(rows.b.end(), {1000000.1, 1000000.3});
  }
  // Rows that alternate depend on each other.
  rows.a = in_order_of(tests::lehmer_sums(2001, rows.a.size()), rows.a);
  rows.b = in_order_of(tests::lehmer_sums(2002, rows.b.size()), rows.b);
  const reports::Suite suite =
      judged(place, rows,
             "  - {claim: mean(a) == 10000000.2003, test: t}\n"
             "  - {claim: mean(a) within 0.01 of 10000000.2003, test: tost}\n");
  for (const tests::Row& row : tests::read_table("numacc")) {
    if (row.text("set") != "4" || row.text("offset") != "10000000.2003") continue;
    const reports::Channel& channel = suite.tests[0].channels.at(0);
    EXPECT_NEAR(*channel.statistic / row["t"], 1, 1e-10);
    const double p = 2 * std::exp(std::min(row["log_lower"], row["log_upper"]));
    EXPECT_NEAR(*channel.p_value / p, 1, 1e-10);
    EXPECT_EQ(suite.tests[1].verdict, Verdict::pass) << suite.tests[1].message;
    return;
  }
  FAIL() << "the table has no such row";
}

}  // namespace
}  // namespace assay::harness
