
#include "estimators/catalogue.h"
#include "harness/command/commands.h"
#include "harness/command/tables.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

/// What a command that ends well prints.
std::string printed(const std::function<int()>& command) {
  const Said said = said_by(command);
  EXPECT_EQ(said.code, 0);
  return said.text;
}

std::vector<Suite> suites_of(const std::vector<std::vector<std::string>>& ids) {
  std::vector<Suite> suites;
  for (const auto& of_suite : ids) {
    suites.emplace_back();
    for (const std::string& id : of_suite) suites.back().tests.emplace_back().id = id;
  }
  return suites;
}

TEST(List, PrintsEveryPluginOnALine) {
  std::string expected;
  for (const Entry& entry : catalogue()) expected += entry.information.name + "\n";
  EXPECT_EQ(printed(list_plugins), expected);
}

TEST(List, PrintsEveryTestOnALineInTheOrderOfTheSuites) {
  const std::vector<Suite> suites = suites_of({{"a/mean(x) == 1", "a/named"}, {"b/other"}});
  EXPECT_EQ(printed([&] { return list_tests(suites, {}); }), "a/mean(x) == 1\na/named\nb/other\n");
  EXPECT_EQ(printed([&] { return list_tests(suites, {.filters = {"-*/named"}}); }),
            "a/mean(x) == 1\nb/other\n");
}

TEST(List, SaysSoWhereNoTestIsSelected) {
  const Said said =
      said_by([] { return list_tests(suites_of({{"a/named"}}), {.tags = {"slow"}}); });
  EXPECT_EQ(said.code, 4);
  EXPECT_TRUE(said.errors.starts_with("assay: --tag slow: "));
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
