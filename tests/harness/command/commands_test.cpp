#include "harness/command/commands.h"

#include "harness/base/record_file.h"
#include "harness/record/replay.h"
#include "reports/formats/json.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

constexpr const char* suite = R"(suite: commands
estimators:
  normal: {plugin: analytic/normal, mean: 2}
tests:
  - {claim: mean(normal) == 2, secondaries: 100}
  - {claim: mean(normal) <= 3, secondaries: 100}
)";

Said ran(const Workplace& place, const std::vector<ReportRequest>& reports) {
  const Suite loaded = load_suite(place.write("suite.yaml", suite));
  return said_by([&] {
    return run_suites({loaded}, {}, {.reports = reports, .colour = Colour::never, .quiet = true});
  });
}

using Commands = Placed;

TEST_F(Commands, RunNothingWhenAFilterMatchesNone) {
  const Suite loaded = load_suite(place.write("suite.yaml", suite));
  const Said run = said_by([&] {
    return run_suites({loaded}, {.selection = {.filters = {"zzz"}}},
                      {.reports = {{"json", place.file("run.json")}}, .quiet = true});
  });
  EXPECT_EQ(run.code, 4);
  EXPECT_EQ(run.text, "");
  EXPECT_TRUE(run.errors.starts_with("assay: --filter zzz matches no test\n")) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(place.file("run.json")));
}

constexpr const char* verdict = " s. False alarms: at most 1 run in\n100.\n";

TEST_F(Commands, ConsoleIsALineASuiteAndTheVerdict) {
  const Said run = ran(place, {});
  EXPECT_EQ(run.code, 0);
  EXPECT_TRUE(run.text.starts_with("commands    2 hold  ")) << run.text;
  EXPECT_NE(run.text.find(" s CPU\n\n✓ All 2 claims are as they should be in "), std::string::npos)
      << run.text;
  EXPECT_TRUE(run.text.ends_with(verdict)) << run.text;
  EXPECT_EQ(run.errors, "");
}

TEST_F(Commands, ReportOnStandardOutputSendsTheConsoleToStandardError) {
  const Said run = ran(place, {{"json", "-"}});
  EXPECT_TRUE(run.text.starts_with("{")) << run.text;
  EXPECT_TRUE(run.errors.ends_with(verdict)) << run.errors;
}

TEST_F(Commands, SavedRunGivesTheReportsOfTheRun) {
  const std::string json = place.file("run.json");
  const std::string junit = place.file("run.xml");
  ASSERT_EQ(ran(place, {{"json", json}, {"junit", junit}}).code, 0);
  const std::string later = place.file("later.xml");
  const Said report = said_by([&] {
    return report_saved_run(json, {.reports = {{"junit", later}}, .colour = Colour::never});
  });
  EXPECT_EQ(report.code, 0);
  EXPECT_FALSE(bytes_in(junit).empty());
  EXPECT_EQ(bytes_in(later), bytes_in(junit));
}

TEST_F(Commands, RecordSurvivesItsFile) {
  const std::string json = place.file("run.json");
  ASSERT_EQ(ran(place, {{"json", json}}).code, 0);
  const reports::Record record = read_record(json);
  EXPECT_EQ(reports::json(read_record(place.write("again.json", reports::json(record)))),
            reports::json(record));
}

TEST_F(Commands, EveryTestHasALineThatReplaysIt) {
  const std::string file = place.write("suite.yaml", suite);
  const std::string other = place.write("other.yaml", suite);
  const auto replayed = [&](bool assigns) {
    const RunOptions options{.seed = 9, .command = "assay run --coarsen 2", .assigns = assigns};
    return run_files({file, other}, options).suites[0].tests[1].replay;
  };
  const std::string rest = " --coarsen 2 --seed 9 --filter 'suite/mean(normal) <= 3'";
  EXPECT_EQ(replayed(false), "assay run " + file + rest);
  // The parameter that is set may be another suite's.
  EXPECT_EQ(replayed(true), "assay run " + file + " " + other + rest);
}

}  // namespace
}  // namespace assay::harness
