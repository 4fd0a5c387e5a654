#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimators/catalogue.h"
#include "harness/command/commands.h"
#include "harness/command/tables.h"

namespace assay::harness {
namespace {

TEST(List, PrintsEveryPluginOnALine) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_plugins(), 0);
  std::fflush(stdout);
  std::string expected;
  for (const Entry& entry : catalogue()) expected += entry.information.name + "\n";
  EXPECT_EQ(testing::internal::GetCapturedStdout(), expected);
}

TEST(List, PrintsEveryTestOnALineInTheOrderOfTheSuites) {
  std::vector<Suite> suites(2);
  suites[0].tests.resize(2);
  suites[0].tests[0].id = "a/mean(x) == 1";
  suites[0].tests[1].id = "a/named";
  suites[1].tests.resize(1);
  suites[1].tests[0].id = "b/other";
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_tests(suites, {}), 0);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a/mean(x) == 1\na/named\nb/other\n");
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_tests(suites, {.filters = {"-*/named"}}), 0);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a/mean(x) == 1\nb/other\n");
}

TEST(List, SaysSoWhereNoTestIsSelected) {
  std::vector<Suite> suites(1);
  suites[0].tests.resize(1);
  suites[0].tests[0].id = "a/named";
  testing::internal::CaptureStderr();
  EXPECT_EQ(list_tests(suites, {.tags = {"slow"}}), 4);
  std::fflush(stderr);
  EXPECT_TRUE(testing::internal::GetCapturedStderr().starts_with("assay: --tag slow: "));
}

/// What `assay list` or `assay describe` prints.
std::string printed(const std::function<int()>& command) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(command(), 0);
  std::fflush(stdout);
  return testing::internal::GetCapturedStdout();
}

TEST(List, PrintsEveryRowOfATableIn80Columns) {
  for (const Table& table : tables()) {
    const std::string text = printed([&] { return list_table(table.plural); });
    for (const TableRow& row : table.rows) {
      EXPECT_THAT(text, testing::HasSubstr(row.name + " ")) << table.plural;
      EXPECT_FALSE(row.summary.empty()) << row.name;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  }
}

TEST(Describe, PrintsTheRowsOfAName) {
  const std::string t = printed([] { return describe("t"); });
  EXPECT_THAT(t, testing::HasSubstr("Student's t"));
  EXPECT_THAT(t, testing::HasSubstr("test: t"));
  // A method and a quantity have this name.
  const std::string quantile = printed([] { return describe("quantile"); });
  EXPECT_THAT(quantile, testing::HasSubstr("quantile, a method"));
  EXPECT_THAT(quantile, testing::HasSubstr("quantile, a quantity"));
  EXPECT_THAT(printed([] { return describe("normal"); }), testing::HasSubstr("normal(mean, sd)"));
  EXPECT_THAT(printed([] { return describe("rounding"); }), testing::HasSubstr("a gate"));
}

}  // namespace
}  // namespace assay::harness
