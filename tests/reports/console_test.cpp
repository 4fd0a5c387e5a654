#include "reports/report_formats.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

/// The example's first suite alone.
Record first_suite() {
  Record record = example_record();
  record.suites.resize(1);
  record.suites[0].statements.clear();
  record.ledger = {};
  return record;
}

Record with_one_test() {
  Record record = first_suite();
  record.suites[0].tests.resize(1);
  return record;
}

TEST(Console, TheLastLineIsTheVerdict) {
  EXPECT_EQ(lines(console(Record{})).back(), "– No claim was tested.");
  EXPECT_EQ(lines(console(with_one_test(), {.width = 100})).back(),
            "✓ Shard 2 of 4: The claim is as it should be in 1 min 23 s. False alarms: at most 1 "
            "run in 100.");
}

TEST(Console, ThePathOfTheReportStandsBelowTheVerdict) {
  EXPECT_TRUE(console(with_one_test(), {.report = "build/report.html"})
                  .ends_with("\n  build/report.html\n"));
}

TEST(Console, PlantedBugsThatAreCaughtAreCounted) {
  Record record = first_suite();
  std::erase_if(record.suites[0].tests, [](const reports::Test& test) { return !test.ok; });
  EXPECT_THAT(console(record), HasSubstr("3 hold, 1 planted bug caught"));
}

TEST(Console, ClaimsThatWereNotRunTakeTheTickAway) {
  Record record = first_suite();
  std::erase_if(record.suites[0].tests, [](const reports::Test& test) { return !test.ok; });
  record.suites[0].tests.back().verdict = Verdict::skipped;
  EXPECT_THAT(console(record),
              HasSubstr("– Shard 2 of 4: 3 of 4 claims as they should be, 1 not tested"));
}

TEST(Console, ABrokenClaimIsToldOnce) {
  const Record record = example_record();
  const reports::Test& broken = record.suites[0].tests[2];
  const std::string told = broken_claim(broken);
  EXPECT_THAT(console(record), HasSubstr(told));
  EXPECT_THAT(console(record, {}, {broken.id}),
              AllOf(Not(HasSubstr(told)), HasSubstr("claims\nbroken, 2 without a verdict")));
}

// A prefix with a star selects the test too.
TEST(Console, AnIdThatIsTooLongForALineEndsInAStar) {
  Record record = example_record();
  reports::Test& test = record.suites[0].tests[2];
  test.replay = "assay run a.yaml --seed 1 --filter 'a/it'\\''s " + std::string(100, 'x') + "'";
  const std::string text = broken_claim(test, {.width = 60});
  EXPECT_THAT(text, HasSubstr("--seed 1 \\\n           --filter 'a/it'\\''s xxx"));
  EXPECT_THAT(text, HasSubstr("xxx*'\n"));
  for (const std::string& line : lines(text)) EXPECT_LE(columns(line), 60) << line;
}

TEST(Console, ClaimsThatWereNotRunAreNamedTogether) {
  Record record = first_suite();
  for (reports::Test& test : record.suites[0].tests) {
    test.verdict = Verdict::skipped;
    test.message = "needs the program `blender`, which is not installed";
  }
  const std::string text = console(record);
  EXPECT_THAT(text, HasSubstr("– 10 claims not run\n    needs the program `blender`"));
}

TEST(Console, ATestThatIsOkIsExplainedIfItIsAlone) {
  for (const int detail : {1, 2}) {
    EXPECT_THAT(console(with_one_test(), {.detail = detail}),
                HasSubstr("replay           assay replay run.json"));
  }
}

TEST(Console, ManyChannelsAreFewLines) {
  Record record = with_one_test();
  ASSERT_FALSE(record.suites[0].estimators.empty());
  EstimatorSummary& estimator = record.suites[0].estimators[0];
  const auto lines_of = [&](std::size_t channels) {
    estimator.channels.resize(channels);
    for (std::size_t i = 0; i < channels; ++i) estimator.channels[i].name = "c" + std::to_string(i);
    return lines(console(record, {.width = 100, .detail = 2})).size();
  };
  const std::size_t most = lines_of(24);
  EXPECT_GT(most, lines_of(23));
  EXPECT_EQ(lines_of(10000), most + 1);
  EXPECT_THAT(console(record, {.detail = 2}), HasSubstr("9976 more channels"));
}

// The numbers of a row as they stand in it, on whichever lines.
TEST(Console, NoNumberIsCutAtAnyWidth) {
  const Record record = example_record();
  for (const int width : {60, 72, 80, 100, 160}) {
    std::string flat;
    for (const std::string& line : lines(console(record, {.width = width, .detail = 2})))
      flat += line.substr(std::min(line.size(), line.find_first_not_of(' '))) + " ";
    for (const char* number : {"-1.62 % (-2.27 % to -0.97 %)", "×0.252 (at most ×0.267)",
                               "+0.031 % (-0.094 % to +0.156 %)", "-9.5 % to +1.5 %)"})
      EXPECT_NE(flat.find(number), std::string::npos) << number << " at " << width;
  }
}

TEST(Console, NeverCutsTheNumberThatAUserIsAskedFor) {
  Record record = record_of({undecided(), undecided()});
  reports::Test& test = record.suites[0].tests[0];
  test.ok = false;
  test.advice = {.words = "give about 44000 rows in all"};
  test.message = "neither shown nor refuted" + std::string(300, 'x') + "; " + test.advice->words;
  for (const Verdict verdict : {Verdict::inconclusive, Verdict::invalid}) {
    test.verdict = verdict;
    EXPECT_THAT(console(record), HasSubstr("\n    to decide: give about 44000 rows in all\n"));
  }
  test.message = "neither shown nor refuted; " + test.advice->words;
  EXPECT_THAT(console(record), HasSubstr("    neither shown nor refuted\n    to decide: give"));
  test.message = "the sample is skewed: " + test.advice->words + "; mind";
  EXPECT_THAT(console(record), HasSubstr("    the sample is skewed; mind\n    to decide: give"));
}

// The heading is what `explain` and `--filter` take.
TEST(Console, AClaimThatIsNotAPassIsHeadedByItsVerdictAndId) {
  Record record = record_of({undecided()});
  reports::Test& test = record.suites[0].tests[0];
  test.id = "file/claim";
  test.file = "";
  test.expected = Verdict::pass;
  EXPECT_THAT(console(record), StartsWith("? inconclusive: file/claim\n    the budget ended"));
  test.expected = Verdict::fail;
  EXPECT_THAT(console(record),
              StartsWith("? inconclusive, but fail expected: file/claim\n    the budget ended"));
  record.suites.push_back(record.suites[0]);
  record.suites[1].tests[0].id = "other/claim";
  EXPECT_THAT(console(record), AllOf(HasSubstr("file   ? 1"), HasSubstr("other  ? 1")));
}

TEST(Console, TheNumberOfOneChannelOfSeveralNamesIt) {
  Record record = with_one_test();
  std::vector<Channel>& channels = record.suites[0].tests[0].channels;
  EXPECT_THAT(console(record), Not(HasSubstr(" of y")));
  channels[0].name = "y";
  channels.push_back(channels[0]);
  channels[1].name = "z";
  EXPECT_THAT(console(record), HasSubstr("+0.156 %) of y"));
}

// Numbers stand beside a claim that leaves them no room for the cost.
TEST(Console, ALongClaimKeepsItsCost) {
  Record record = with_one_test();
  reports::Test& test = record.suites[0].tests[0];
  test.name = "mean(" + std::string(50, 'x') + ") == analytic";
  EXPECT_THAT(console(record), HasSubstr("\n    " + plain_spaces(cost_text(total_cost(test)))));
}

TEST(Console, AFailedClaimWithACaveatCanStillBeRepeated) {
  Record record = record_of({failing()});
  reports::Test& test = record.suites[0].tests[0];
  test.advice = {.words = "the reference is taken as exact"};
  test.replay = "assay run a.yaml";
  EXPECT_THAT(console(record), HasSubstr("    note: the reference is taken as exact\n"
                                         "    again: assay run a.yaml\n"));
}

TEST(Console, TheRowOfAFailedImageIsTheFindingAtItsPlace) {
  Record record = record_of({failing(), failing()});
  std::vector<reports::Test>& tests = record.suites[0].tests;
  tests[0].image->winner = {.place = "x 1, y 2", .effect = mean_effect(0.0162, 0.002)};
  tests[1].image->winner = {.statistic = "alternating", .place = "the whole image"};
  tests[0].samples = {{.secondaries = 64}, {.secondaries = 63}};
  EXPECT_THAT(console(record, {.detail = 1}), HasSubstr("+1.62 % ("));
  EXPECT_EQ(cost_text(tests[0]), "127\u00a0pictures");
  EXPECT_EQ(display(tests[1]).effect + display(tests[1]).interval, "") << "signs have no effect";
}

TEST(Console, NoTwoLinesInARowAreEmpty) {
  Record record = example_record();
  record.note = "first\n\n\nsecond";
  record.suites[0].tests[2].message = "one\n\ntwo";
  EXPECT_EQ(console(record, {.width = 100, .detail = 2}).find("\n\n\n"), std::string::npos);
  EXPECT_THAT(console(record, {.width = 100, .detail = 2}), HasSubstr("first\nsecond.\n"));
}

TEST(Console, ColourChangesNoText) {
  const std::string coloured = console(example_record(), {.colour = true});
  EXPECT_THAT(coloured, HasSubstr("\x1b[1;31m"));
  EXPECT_EQ(std::regex_replace(coloured, std::regex("\x1b\\[[0-9;]*m"), ""),
            console(example_record()));
}

// A command to paste is whole, whatever its width.
RC_GTEST_PROP(Console, NoLineButACommandIsWiderThanAskedFor, ()) {
  Record record = random_record();
  for (Suite& suite : record.suites) {
    for (Test& test : suite.tests) {
      test.replay.clear();
      test.advice.reset();
    }
  }
  const int width = *rc::gen::element(60, 80, 100, 200);
  const int detail = *rc::gen::element(0, 1, 2);
  const std::string text = console(record, {.width = width, .detail = detail});
  for (const std::string& line : lines(text)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(clean(text) == text);
}

TEST(Console, NeverCutsTheCommandThatRepeatsATest) {
  Record record = with_one_test();
  const std::string claim = "'mean(" + std::string(200, 'x') + ") == analytic'";
  record.suites[0].tests[0].replay = "assay check " + claim + " --seed 1";
  const std::string text = console(record, {.detail = 2});
  EXPECT_THAT(text, HasSubstr(claim + " \\\n"));
}

}  // namespace
}  // namespace assay::reports
