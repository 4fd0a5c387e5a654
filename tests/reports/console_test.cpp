#include "reports/formats/console.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/words/columns.h"
#include "reports/words/text.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

/// The example with this one of its first suite's tests.
Record only(std::size_t test) {
  Record record = example_record();
  record.suites.resize(1);
  record.suites[0].statements.clear();
  record.suites[0].tests = {record.suites[0].tests.at(test)};
  record.ledger = {};
  return record;
}

/// Blocks of lines between empty ones.
std::vector<std::vector<std::string>> blocks(const std::string& text) {
  std::vector<std::vector<std::string>> all(1);
  for (const std::string& line : lines(text)) {
    if (!line.empty()) {
      all.back().push_back(line);
    } else if (!all.back().empty()) {
      all.emplace_back();
    }
  }
  return all;
}

TEST(Console, TheLastLineIsTheVerdict) {
  for (const int detail : {0, 1, 2}) {
    const auto all = lines(console(example_record(), {.width = 120, .detail = detail}));
    EXPECT_EQ(all.back(),
              "✗ 5 of 13 claims broken; 1 ledger alarm in 1 min 23 s. False alarms: at most "
              "15 runs in 1,000.");
  }
  EXPECT_EQ(lines(console(Record{})).back(), "– No claim was tested.");
  EXPECT_EQ(lines(console(only(0), {.width = 100})).back(),
            "✓ The claim is as it should be in 1 min 23 s. False alarms: at most 1 run in 100.");
}

TEST(Console, ThePathOfTheReportStandsBelowTheVerdict) {
  EXPECT_TRUE(
      console(only(0), {.report = "build/report.html"}).ends_with("\n  build/report.html\n"));
}

TEST(Console, ASuiteIsALine) {
  const auto all = blocks(console(example_record()));
  EXPECT_EQ(all[0].size(), 2U);
  EXPECT_EQ(all[0][0].find("triangle luminaire"), 0U);
  EXPECT_NE(all[0][0].find("✗ 4 as they should be, 4 broken, 1 undecided, 1 not run"),
            std::string::npos)
      << all[0][0];
}

TEST(Console, PlantedBugsThatAreCaughtAreCounted) {
  Record record = example_record();
  record.suites.resize(1);
  std::erase_if(record.suites[0].tests, [](const reports::Test& test) { return !test.ok; });
  EXPECT_NE(console(record).find("3 hold, 1 planted bug caught"), std::string::npos);
}

// Every claim that is not as it should be, at every width.
TEST(Console, ABrokenClaimTakesFiveLinesAtMost) {
  for (const int width : {60, 80, 120}) {
    const std::string text = console(example_record(), {.width = width});
    int shown = 0;
    for (const auto& block : blocks(text)) {
      if (!block[0].starts_with("✗ triangle luminaire:") && !block[0].starts_with("? ")) continue;
      ++shown;
      EXPECT_LE(block.size(), 5U) << block[0];
      EXPECT_GE(block.size(), 3U) << block[0];
    }
    EXPECT_GE(shown, 5);
  }
}

TEST(Console, ABrokenClaimSaysWhereWhatAndHowAgain) {
  Console screen({.width = 100});
  const Record record = example_record();
  EXPECT_EQ(
      screen.broken(record.suites[0], record.suites[0].tests[2]),
      "✗ triangle luminaire: mean(winners) == mean(hemisphere)" + std::string(22, ' ') +
          "suites/triangle.yaml:18\n"
          "    x 2-3, y 1-2 of green is 1.62 % too dark (0.97 % to 2.27 %); you asked to catch "
          "0.5 %.\n"
          "    again: assay replay run.json 'triangle/mean(winners) == mean(hemisphere)'\n\n");
}

TEST(Console, ABrokenClaimIsToldOnce) {
  const Record record = example_record();
  Console screen({});
  const std::string told = screen.broken(record.suites[0], record.suites[0].tests[2]);
  EXPECT_NE(console(record).find(told), std::string::npos);
  EXPECT_EQ(screen.rest(record).find(told), std::string::npos);
  EXPECT_NE(screen.rest(record).find("5 of 13 claims broken"), std::string::npos);
}

// A prefix with a star selects the test too.
TEST(Console, AnIdThatIsTooLongForALineEndsInAStar) {
  Record record = example_record();
  reports::Test& test = record.suites[0].tests[2];
  test.replay = "assay run a.yaml --seed 1 --filter 'a/it'\\''s " + std::string(100, 'x') + "'";
  Console screen({.width = 60});
  const std::string text = screen.broken(record.suites[0], test);
  EXPECT_NE(text.find("--filter \\\n           'a/it'\\''s xxx"), std::string::npos) << text;
  EXPECT_NE(text.find("xxx*'\n"), std::string::npos) << text;
  for (const std::string& line : lines(text)) EXPECT_LE(columns(line), 60) << line;
}

TEST(Console, ATestIsALineAtMoreDetail) {
  for (const int width : {60, 80, 120}) {
    const auto all = blocks(console(example_record(), {.width = width, .detail = 1}));
    EXPECT_EQ(all[0].size(), 12U)
        << width;  // the suite, 10 tests, the confidence of their brackets
    EXPECT_NE(all[0][1].find("+0.031 % [-0.094 %, +0.156 %]"), std::string::npos);
  }
}

TEST(Console, TheSlowestTestsAreNamedInOrder) {
  Record record = example_record();
  record.suites.resize(1);
  for (reports::Test& test : record.suites[0].tests) {
    for (Sample& sample : test.samples) sample.cost.seconds = 0;
  }
  record.suites[0].tests[1].samples[0].cost.seconds = 12;
  record.suites[0].tests[4].samples[0].cost.seconds = 0.4;
  const std::string text = console(record, {.slowest = 2});
  EXPECT_NE(text.find("Slowest, by CPU time of their draws:\n"
                      "        12 s  triangle/variance(area) < variance(hemisphere)\n"
                      "       0.4 s  triangle/mean(shared_seed) == analytic\n\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(console(record).find("Slowest"), std::string::npos);
}

TEST(Console, ClaimsThatWereNotRunAreNamedTogether) {
  Record record = example_record();
  record.suites.resize(1);
  for (reports::Test& test : record.suites[0].tests) {
    test.verdict = Verdict::skipped;
    test.message = "needs the program `blender`, which is not installed";
  }
  const std::string text = console(record);
  EXPECT_NE(text.find("– 10 claims not run\n    needs the program `blender`"), std::string::npos)
      << text;
}

TEST(Console, WhatIsNotOkIsExplainedAndWhatIsOkIsNot) {
  const std::string text = console(example_record(), {.detail = 2});
  EXPECT_NE(text.find("replay           assay replay run.json"), std::string::npos);
  EXPECT_EQ(text.find("replay           assay replay run.json 'triangle/mean(area)"),
            std::string::npos);
  EXPECT_NE(console(only(0), {.detail = 2}).find("replay           assay replay run.json"),
            std::string::npos);
}

TEST(Console, ManyChannelsAreFewLines) {
  Record record = only(0);
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
  EXPECT_NE(console(record, {.detail = 2}).find("9976 more channels"), std::string::npos);
}

TEST(Console, AnExpectedFailureIsNotShownAsAFailure) {
  const std::string text = console(example_record(), {.detail = 2});
  EXPECT_NE(text.find("✓ fail (as expected) "), std::string::npos);
  EXPECT_NE(text.find("✗ pass, but fail expected "), std::string::npos);
  EXPECT_EQ(text.find("✓ fail  "), std::string::npos);
}

// The numbers of a row as they stand in it, on whichever lines.
TEST(Console, NoNumberIsCutAtAnyWidth) {
  const Record record = example_record();
  for (const int width : {60, 72, 80, 100, 160}) {
    std::string flat;
    for (const std::string& line : lines(console(record, {.width = width, .detail = 2})))
      flat += line.substr(std::min(line.size(), line.find_first_not_of(' '))) + " ";
    for (const char* number : {"-2.04 % [-2.25 %, -1.83 %]", "×0.252 [to ×0.267]",
                               "+0.031 % [-0.094 %, +0.156 %]", "-9.5 %, +1.5 %]"})
      EXPECT_NE(flat.find(number), std::string::npos) << number << " at " << width;
  }
}

TEST(Console, TheConfidenceOfBracketsIsSaid) {
  Record record = example_record();
  EXPECT_NE(console(record, {.width = 100, .detail = 2}).find("Brackets are 99 % intervals"),
            std::string::npos);
  record.suites[0].tests[0].channels[0].effect.confidence = 0.9995;
  EXPECT_NE(console(record, {.width = 100, .detail = 2}).find("+0.156 %] at 99.95 %"),
            std::string::npos);
}

TEST(Console, NoTwoLinesInARowAreEmpty) {
  Record record = example_record();
  record.note = "first\n\n\nsecond";
  record.suites[0].tests[2].message = "one\n\ntwo";
  EXPECT_EQ(console(record, {.width = 100, .detail = 2}).find("\n\n\n"), std::string::npos);
  EXPECT_NE(console(record, {.width = 100, .detail = 2}).find("first\nsecond\n"),
            std::string::npos);
}

TEST(Console, DetailsCountVerdictsAndTheirErrors) {
  const std::string text = console(example_record(), {.width = 200, .detail = 2});
  EXPECT_NE(text.find("\nVerdicts: 1 pass, but fail expected; 1 error;"), std::string::npos);
  EXPECT_NE(text.find("some test would fail by chance with probability 0.015 at most"),
            std::string::npos);
}

TEST(Console, ColourIsWrittenOnlyWhenAskedFor) {
  EXPECT_EQ(console(example_record()).find('\x1b'), std::string::npos);
  EXPECT_NE(console(example_record(), {.colour = true}).find("\x1b[1;31m"), std::string::npos);
}

TEST(Console, ColourChangesNoText) {
  const std::string coloured = console(example_record(), {.colour = true});
  std::string bare;
  for (std::size_t i = 0; i < coloured.size(); ++i) {
    if (coloured[i] == '\x1b')
      i = coloured.find('m', i);
    else
      bare += coloured[i];
  }
  EXPECT_EQ(bare, console(example_record()));
}

// A command to paste is whole, whatever its width.
RC_GTEST_PROP(Console, NoLineButACommandIsWiderThanAskedFor, ()) {
  Record record = random_record();
  for (Suite& suite : record.suites) {
    for (Test& test : suite.tests) test.replay.clear();
  }
  const int width = *rc::gen::element(60, 80, 100, 200);
  const int detail = *rc::gen::element(0, 1, 2);
  const std::string text = console(record, {.width = width, .detail = detail});
  for (const std::string& line : lines(text)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(clean(text) == text);
}

TEST(Console, NeverCutsTheCommandThatRepeatsATest) {
  Record record = only(0);
  const std::string claim = "'mean(" + std::string(200, 'x') + ") == analytic'";
  record.suites[0].tests[0].replay = "assay check " + claim + " --seed 1";
  const std::string text = console(record, {.detail = 2});
  EXPECT_NE(text.find(claim + " \\\n"), text.npos);
}

}  // namespace
}  // namespace assay::reports
