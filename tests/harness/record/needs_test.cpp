// `needs:` of a suite: without a program its tests are skipped, and nothing of it is prepared.

#include "harness/record/record_of.h"
#include "harness/suite/run_options.h"
#include "reports/report_formats.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

// Were the estimator prepared, that it cannot be found would end the run.
constexpr const char* renderer = R"(suite: renderer
needs: [sh, no_such_renderer]
estimators:
  image: {plugin: process, command: [no_such_renderer]}
tests:
  - {claim: mean(image) == 1}
  - {claim: mean(image) <= 2, expect: fail}
statements:
  - {text: Images are bright., source: a talk, holds: ["mean(image) == 1"]}
)";

constexpr const char* normal = R"(suite: normal
needs: [sh]
estimators:
  normal: {plugin: analytic/normal, primaries: 1}
tests:
  - {claim: mean(normal) == 0}
)";

class Needs : public Placed {
 protected:
  const std::vector<std::string> files{place.write("renderer.yaml", renderer),
                                       place.write("normal.yaml", normal)};
};

TEST_F(Needs, SkipTheTestsOfASuiteThatLacksAProgram) {
  const reports::Record record = run_text(renderer);
  ASSERT_EQ(record.suites[0].tests.size(), 2u);
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_EQ(test.verdict, Verdict::skipped);
    EXPECT_EQ(test.message, "needs the program `no_such_renderer`, which is not installed");
  }
  EXPECT_EQ(record.suites[0].statements.size(), 1u);
  EXPECT_EQ(record.note, "");
  EXPECT_EQ(exit_code(record, InconclusivePolicy::report), 77);
}

TEST_F(Needs, LeaveOtherSuitesAsTheyAre) {
  const reports::Record record = run_files(files);
  EXPECT_EQ(record.suites[1].tests[0].verdict, Verdict::pass);
  EXPECT_EQ(record.note, "");
  EXPECT_EQ(exit_code(record, InconclusivePolicy::report), 0);
  EXPECT_EQ(reports::read_json(reports::json(record), "record"), record);
}

TEST_F(Needs, MergeToTheRecordOfOneRun) {
  std::vector<ShardFile> shards;
  for (const unsigned i : {1U, 2U}) {
    RunOptions options;
    options.shard = {i, 2U};
    shards.push_back({std::to_string(i) + ".json", run_files(files, options)});
  }
  EXPECT_EQ(numbers_of(merge(shards)), numbers_of(run_files(files)));
}

TEST_F(Needs, IsAListOfPrograms) {
  const std::string without = std::regex_replace(normal, std::regex("needs.*\n"), "");
  for (const char* wrong : {"needs: blender", "needs: []", "needs: {blender: 3}"}) {
    const std::string file = place.write("suite.yaml", std::string(wrong) + "\n" + without);
    EXPECT_EQ(refusal([&] { load_suite(file); }),
              "1:8: `needs` must be a list of programs: `needs: [blender]`")
        << wrong;
  }
}

}  // namespace
}  // namespace assay::harness
