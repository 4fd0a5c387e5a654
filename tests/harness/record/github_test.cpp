#include "harness/record/record_of.h"
#include "reports/report_formats.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

Environment of(const std::string& actions, const std::string& summary) {
  return [=](const std::string& name) {
    if (name == "GITHUB_ACTIONS") return actions;
    return name == "GITHUB_STEP_SUMMARY" ? summary : std::string();
  };
}

reports::Record failing() {
  reports::Record record;
  record.suites.resize(1);
  record.suites[0].name = "suite";
  record.suites[0].tests.resize(1);
  reports::Test& test = record.suites[0].tests[0];
  test.id = "suite/bad";
  test.name = "bad";
  test.file = "suites/suite.yaml";
  test.line = 7;
  test.verdict = reports::Verdict::fail;
  return record;
}

using Github = Placed;

TEST_F(Github, IsToldNothingElsewhere) {
  EXPECT_EQ(tell_github(failing(), of("", place.file("summary"))), "");
  EXPECT_EQ(tell_github(failing(), of("false", place.file("summary"))), "");
  EXPECT_FALSE(std::filesystem::exists(place.file("summary")));
}

TEST_F(Github, KeepsTheWholeSummaryBelowTheLimit) {
  reports::Record record = failing();
  record.suites[0].tests.resize(2000, record.suites[0].tests[0]);
  const std::string file = place.write("summary", std::string(reports::markdown_limit - 9000, 'x'));
  tell_github(record, of("true", file));
  EXPECT_LE(std::filesystem::file_size(file), reports::markdown_limit);
  EXPECT_THAT(bytes_in(file), EndsWith("the JSON record has them all.\n\n"));
}

TEST_F(Github, LeavesAFullSummaryAndSaysSo) {
  const std::string full(reports::markdown_limit - 100, 'x');
  const std::string file = place.write("summary", full);
  EXPECT_THAT(tell_github(failing(), of("true", file)), HasSubstr("summary is full"));
  EXPECT_EQ(bytes_in(file), full);
  EXPECT_THAT(tell_github(failing(), of("true", place.file("no/folder"))),
              HasSubstr("summary cannot be written"));
}

}  // namespace
}  // namespace assay::harness
