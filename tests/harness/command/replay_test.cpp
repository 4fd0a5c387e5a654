#include <fmt/format.h>

#include "harness/base/record_file.h"
#include "harness/command/commands.h"
#include "harness/sampling/pool.h"
#include "harness/sampling/prepare.h"
#include "reports/report_formats.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

Said said(const ReplayArguments& arguments) {
  std::string trouble;
  Said said = said_by([&] {
    int code = 2;
    trouble = thrown([&] { code = replay(arguments); });
    return code;
  });
  if (said.code == 2) said.text += trouble;
  return said;
}

constexpr const char* replayed_suite = R"(suite: replayed
estimators:
  uniform: {plugin: analytic/exponential_uniform}
  again: {plugin: analytic/exponential_uniform}
  normal: {plugin: analytic/normal, mean: 2}
  area: {plugin: luminaire/area, scene: {
    receiver: {position: [0, 0, 0], normal: [0, 0, 1]},
    light: {polygon: [[0, 0, 1], [0, 1, 1], [1, 0, 1]], radiance: 2}}}
  hemisphere: {plugin: luminaire/hemisphere, scene: cornell_triangle}
  no_cosine: {plugin: mutants/no_cosine, scene: triangle}
  ratio: {plugin: analytic/ratio, primaries: 16}
  spoilt: {plugin: mutants/rare_nan, probability: 0.05, primaries: 1}
  zero: {plugin: analytic/zero_variance}
tests:
  - {name: mean, claim: mean(uniform) == analytic, detect: 2%}
  - {name: absolute, claim: mean(uniform) == analytic, detect: 0.2}
  - {name: allowed, claim: mean(uniform) <= 6.3, allow: 1%, detect: 3%}
  - {name: means, claim: mean(area) == mean(uniform), detect: 5%, expect: fail}
  - {name: one stream, claim: mean(uniform) == mean(again), detect: 5%}
  - {name: variance, claim: variance(normal) == analytic, detect: 40%}
  - {name: variances, claim: variance(uniform) == variance(again), detect: 50%}
  - {name: of a ratio, claim: mean(ratio) >= 6}
  - {name: within, claim: mean(area) within 5% of analytic}
  - {name: law, claim: 'distribution(normal) == normal(2, 1)', detect: 0.1}
  - {name: cells, claim: distribution(hemisphere.direction) == density}
  - {name: mutant, claim: mean(no_cosine) == analytic, detect: 5%, expect: fail}
  - {name: spoilt, claim: mean(spoilt) == 0}
  - {name: zero, claim: mean(zero) == analytic}
)";

/// The suite's record, as a file.
std::string recorded(const Workplace& place, const std::string& text = replayed_suite,
                     const RunOptions& options = repeatable) {
  return place.write("run.json",
                     reports::json(run_files({place.write("suite.yaml", text)}, options)));
}

void expect_replayed(const ReplayArguments& arguments, const std::vector<std::string>& words,
                     int code = 0) {
  const Said now = said(arguments);
  EXPECT_EQ(now.code, code) << now.text;
  for (const std::string& each : words) EXPECT_THAT(now.text, HasSubstr(each));
}

void expect_same_numbers(const std::string& file, const std::string& test) {
  expect_replayed({.record = file, .test = test}, {"the same numbers as recorded"});
}

using Replays = Placed;

TEST_F(Replays, GivesTheSameNumbersForEveryKindOfClaim) {
  const std::string file = recorded(place, replayed_suite, {.seed = 5, .command = "assay run"});
  const reports::Record record = read_record(file);
  for (const reports::Test& test : record.suites[0].tests) expect_same_numbers(file, test.id);
}

// Pairs share random numbers, also through others, and other claims on them draw these.
TEST_F(Replays, OfPairsDrawsTheNumbersThatTheyShare) {
  const std::string size = "width: 6, height: 4, primaries: 2}";
  const std::string file = recorded(place, R"(suite: pairs
estimators:
  a: {plugin: path_tracing/image, integrator: multiple, )" +
                                               size + R"(
  b: {plugin: path_tracing/image, integrator: bsdf, )" +
                                               size + R"(
  c: {plugin: path_tracing/image, integrator: light, )" +
                                               size + R"(
tests:
  - {name: first, claim: mean(a) == mean(b), paired: true, secondaries: 16}
  - {name: second, claim: mean(b) == mean(c), paired: true, secondaries: 16}
  - {name: law, claim: distribution(b) == distribution(c), secondaries: 16}
  - {name: alone, claim: mean(c) == 0.5, secondaries: 16}
)");
  const reports::Record record = read_record(file);
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_EQ(test.paired, test.name == "first" || test.name == "second");
    expect_same_numbers(file, test.id);
    const Said one = said({.record = file, .test = test.id, .observation = 15});
    EXPECT_EQ(one.code, 0);
    // The mean of each side, and that at the finding's place.
    EXPECT_THAT(one.text, HasSubstr("mean of observation 15: "));
    EXPECT_THAT(one.text, HasSubstr("its mean at " + test.image->winner.place + ": "));
    EXPECT_LE(std::ranges::count(one.text, '\n'), 14) << one.text;
  }
}

// Its own data's gate makes every look count for nothing, in the run as in the replay.
TEST_F(Replays, OfASlopeThatLiesOnNoPowerLawIsTheSame) {
  const std::string file = recorded(place, R"(suite: bent
estimators:
  ratio: {plugin: analytic/ratio}
tests:
  - {name: bent, claim: slope(bias(ratio)) within 0.1 of -1, over: {primaries: [1, 2, 4, 8]}, secondaries: 20000}
  - {name: forced, claim: slope(bias(ratio)) == -1, test: slope, over: {primaries: [1, 2, 4, 8]}, secondaries: 20000}
)");
  const std::vector<reports::Test> tests = read_record(file).suites[0].tests;
  expect_said(tests[0], reports::Verdict::invalid, {"lie on no power law"});
  EXPECT_EQ(tests[1].verdict, reports::Verdict::fail);
  for (const char* test : {"bent", "forced"}) expect_same_numbers(file, test);
}

TEST_F(Replays, OfSecondsComparesWhatRepeats) {
  const std::string file = recorded(place, R"(suite: timed
estimators:
  one: {plugin: analytic/exponential_uniform}
tests:
  - {name: cost, claim: cost(one) <= 1, cost: seconds}
)");
  expect_replayed({.record = file, .test = "cost"}, {"their seconds differ"});
}

TEST_F(Replays, UsesTheSeedOfTheTestsOwnSuite) {
  const std::string one = place.write("one.yaml", "seed: 3\n" + std::string(replayed_suite));
  const std::string two = place.write("two.yaml", "seed: 4\n" + std::string(replayed_suite));
  const std::string file =
      place.write("run.json", reports::json(run_files({one, two}, repeatable)));
  EXPECT_EQ(said({.record = file, .test = "two/mean"}).code, 0);
  EXPECT_EQ(refusal([&] { replay({.record = file, .test = "mean"}); }),
            "2 tests match `mean`; give the id of one, or more of it: `one/mean`, `two/mean`");
}

TEST_F(Replays, PrintsTheValueThatWasDrawn) {
  const std::string file = recorded(place);
  const PreparedEstimator uniform =
      prepare({.name = "uniform", .plugin = "analytic/exponential_uniform"}, ".");
  const std::uint64_t primaries = test_named(read_record(file), "mean").samples[0].primaries;
  double value = 0;
  Pool(uniform.setup, key_of(uniform, 1, 0, ""), primaries)
      .draw_again(*uniform.setup->make(), 17, {&value, 1});
  expect_replayed({.record = file, .test = "mean", .observation = 17},
                  {fmt::format("observation 17: {}\n", value)});
}

// The test saw numbers in single precision.
TEST_F(Replays, EveryObservationOfAnImageLiesInItsRecordedRange) {
  const std::string file = recorded(place, R"(suite: image
estimators:
  image: {plugin: depth_of_field/image, width: 4, height: 3, primaries: 1}
tests:
  - {name: pixel, claim: mean(image.x1y1) == analytic, secondaries: 32}
)");
  for (std::uint64_t index = 0; index < 32; ++index) {
    const Said now = said({.record = file, .test = "pixel", .observation = index});
    EXPECT_EQ(now.code, 0) << index;
    EXPECT_THAT(now.text, AllOf(HasSubstr("image.x1y1"), Not(HasSubstr("image.x0y0"))));
  }
}

TEST_F(Replays, OfADrawShowsItsPoint) {
  expect_replayed({.record = recorded(place), .test = "cells", .observation = 5},
                  {"\n  draw of `direction`: point ("});
}

TEST_F(Replays, DrawsTheVeryObservationThatIsNotANumber) {
  const std::string file = recorded(place);
  const std::string message = test_named(read_record(file), "spoilt").message;
  const std::string before = "the first is observation ";
  const std::size_t at = message.find(before);
  ASSERT_NE(at, std::string::npos) << message;
  const std::uint64_t index = std::stoull(message.substr(at + before.size()));
  expect_replayed({.record = file, .test = "spoilt", .observation = index},
                  {": nan", "  not finite, as "});
}

TEST_F(Replays, SaysHowManyObservationsAreNotFinite) {
  reports::Record record = read_record(recorded(place));
  const reports::Test test = test_named(record, "spoilt");
  const std::string line = fmt::format("{:<27} {};", "not finite", test.samples[0].nonfinite);
  const std::string file = place.write("run.json", reports::json(record));
  expect_replayed({.record = file, .test = "spoilt"},
                  {"error, so the numbers below decide nothing", line});
  for (reports::Test& each : record.suites[0].tests) {
    if (each.name == "spoilt") each.samples[0].nonfinite = 1;
  }
  const std::string tampered = place.write("tampered.json", reports::json(record));
  expect_replayed({.record = tampered, .test = "spoilt"}, {"(recorded: 1)"}, 1);
}

TEST_F(Replays, HoldsOneObservationAgainstTheRecordedRange) {
  reports::Record record = read_record(recorded(place));
  const std::string file = place.write("run.json", reports::json(record));
  expect_replayed({.record = file, .test = "mean", .observation = 17}, {"  lies in ["});
  record.suites[0].tests[0].samples[0].min = 1e6;
  record.suites[0].tests[0].samples[0].max = 2e6;
  record.suites[0].tests[0].samples[0].mean = 6.5;
  const std::string tampered = place.write("tampered.json", reports::json(record));
  expect_replayed({.record = tampered, .test = "mean", .observation = 17},
                  {"NOT as recorded: lies outside [1"}, 1);
  expect_replayed({.record = tampered, .test = "mean"}, {"(recorded: 6.5)"}, 1);
}

TEST_F(Replays, OfOneObservationKnowsTheTwoSidesOfOneEstimatorApart) {
  const std::string file = recorded(place, R"(suite: twice
estimators:
  one: {plugin: analytic/normal, primaries: 1}
tests:
  - {name: same, claim: mean(one) == mean(one), secondaries: 2}
)");
  for (const std::uint64_t index : {0U, 1U}) {
    expect_replayed({.record = file, .test = "same", .observation = index}, {});
  }
}

TEST_F(Replays, NamesTestsWhereNoneIsNear) {
  EXPECT_EQ(refusal([] { replay({.record = "none.json", .test = "suite/mean"}); }),
            "there is no such file; `--report json=FILE` saves a run");
  const std::string file = recorded(place);
  const auto refused = [&](const std::string& test) {
    return refusal([&] { replay({.record = file, .test = test}); });
  };
  EXPECT_EQ(refused("stream"), "(nothing was refused)");
  EXPECT_EQ(refused("onestream"), "(nothing was refused)");
  EXPECT_EQ(refused("one straem"), "no test `one straem` in this run; did you mean `one stream`?");
  EXPECT_EQ(refused("XX"),
            "no test `XX` in this run; there is: `suite/mean`, `suite/absolute`, `suite/allowed`, "
            "`suite/means`, `suite/one stream`, …");
}

TEST_F(Replays, RefusesAnObservationThatWasNotDrawn) {
  const std::string file = recorded(place);
  EXPECT_THAT(refusal([&] { replay({.record = file, .test = "zero", .observation = 16384}); }),
              HasSubstr("the test used 0 to 16383"));
}

TEST_F(Replays, FindsRecordedDataFromTheSuitesFolder) {
  place.write("data.txt", "# columns: a b\n1 2\n3 4\n5 7\n");
  const std::string file = recorded(place, R"(suite: data
estimators:
  all: {plugin: recorded, file: data.txt}
  one: {plugin: recorded, file: data.txt, column: b}
tests:
  - {name: all, claim: mean(all) == 3, test: t}
  - {name: one, claim: mean(one) == 3, test: t}
)");
  for (const char* test : {"all", "one"}) expect_replayed({.record = file, .test = test}, {});
  place.write("data.txt", "# columns: a b\n1 2\n3 4\n");
  expect_replayed({.record = file, .test = "all"}, {"secondaries                 2   (recorded: 3"},
                  1);
  expect_replayed({.record = file, .test = "all", .observation = 2}, {}, 1);
}

TEST_F(Replays, SaysThatTheNumbersOfAnInvalidTestDecideNothing) {
  std::string rows;
  for (int i = 0; i < 50; ++i) rows += fmt::format("{}\n", (i * 37 % 101) * (i * 53 % 103) % 211);
  place.write("rows.txt", rows);
  const std::string file = recorded(place, R"(suite: few
estimators:
  rows: {plugin: recorded, file: rows.txt}
tests:
  - {name: few, claim: variance(rows) == 1, detect: 5%}
)");
  const reports::Test test = read_record(file).suites[0].tests[0];
  ASSERT_EQ(test.verdict, reports::Verdict::invalid) << test.message;
  const Said now = said({.record = file, .test = test.id});
  EXPECT_THAT(now.text,
              HasSubstr("invalid, so the numbers below decide nothing: `rows` has 50 rows"));
  EXPECT_THAT(now.text, HasSubstr("variance of an observation"));
}

}  // namespace
}  // namespace assay::harness
