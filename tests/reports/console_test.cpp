#include "reports/formats/console.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <sstream>

#include "reports/words/columns.h"
#include "reports/words/text.h"
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

TEST(Console, TheLastLineCounts) {
  const auto all = lines(console(example_record()));
  EXPECT_EQ(all.back(), "5 passed, 5 failed, 3 skipped");
  EXPECT_EQ(all[all.size() - 2],
            "Counted below: ok as passed, not ok as failed, undecided and not run as skipped.");
  EXPECT_EQ(lines(console(Record{})).back(), "0 passed, 0 failed, 0 skipped");
}

// Verdicts that are counted under their own names need no word.
TEST(Console, TheLastLineIsExplainedOnlyWhereItsWordsAreNoVerdicts) {
  Record record = example_record();
  record.suites.resize(1);
  std::vector<reports::Test>& tests = record.suites[0].tests;
  tests = {tests[0], tests[2]};
  ASSERT_EQ(tests[1].verdict, Verdict::fail);
  EXPECT_EQ(console(record).find("Counted below"), std::string::npos);
  tests[1].verdict = Verdict::invalid;
  EXPECT_NE(console(record).find("Counted below"), std::string::npos);
}

TEST(Console, WhatIsNotOkIsExplainedAndWhatIsOkIsNot) {
  const std::string text = console(example_record());
  EXPECT_NE(text.find("replay           assay replay run.json 'triangle/mean(winners)"),
            std::string::npos);
  EXPECT_EQ(text.find("replay           assay replay run.json 'triangle/mean(area)"),
            std::string::npos);
  EXPECT_NE(console(example_record(), {.verbose = true})
                .find("replay           assay replay run.json 'triangle/mean(area)"),
            std::string::npos);
}

TEST(Console, ManyChannelsAreFewLines) {
  Record record = example_record();
  ASSERT_FALSE(record.suites[0].estimators.empty());
  EstimatorSummary& estimator = record.suites[0].estimators[0];
  const auto lines_of = [&](std::size_t channels) {
    estimator.channels.resize(channels);
    for (std::size_t i = 0; i < channels; ++i) estimator.channels[i].name = "c" + std::to_string(i);
    return lines(console(record, {.verbose = true})).size();
  };
  const std::size_t most = lines_of(24);
  EXPECT_GT(most, lines_of(23));
  EXPECT_EQ(lines_of(10000), most + 1);
  EXPECT_NE(console(record, {.verbose = true}).find("9976 more channels"), std::string::npos);
}

TEST(Console, AnExpectedFailureIsNotShownAsAFailure) {
  const std::string text = console(example_record());
  EXPECT_NE(text.find("✓ fail (as expected) "), std::string::npos);
  EXPECT_NE(text.find("✗ pass, but fail expected "), std::string::npos);
  EXPECT_EQ(text.find("✓ fail  "), std::string::npos);
}

// The numbers of a row as they stand in it, on whichever lines.
TEST(Console, NoNumberIsCutAtAnyWidth) {
  const Record record = example_record();
  for (const int width : {60, 72, 80, 100, 160}) {
    std::string flat;
    for (const std::string& line : lines(console(record, {.width = width})))
      flat += line.substr(std::min(line.size(), line.find_first_not_of(' '))) + " ";
    for (const char* number : {"-2.04 % [-2.25 %, -1.83 %]", "×0.252 [to ×0.267]",
                               "+0.031 % [-0.094 %, +0.156 %]", "-9.5 %, +1.5 %]"})
      EXPECT_NE(flat.find(number), std::string::npos) << number << " at " << width;
  }
}

TEST(Console, TheConfidenceOfBracketsIsSaid) {
  Record record = example_record();
  EXPECT_NE(console(record).find("Brackets are 99 % intervals"), std::string::npos);
  record.suites[0].tests[0].channels[0].effect.confidence = 0.9995;
  EXPECT_NE(console(record).find("+0.156 %] at 99.95 %"), std::string::npos);
}

TEST(Console, NoTwoLinesInARowAreEmpty) {
  Record record = example_record();
  record.note = "first\n\n\nsecond";
  record.suites[0].tests[2].message = "one\n\ntwo";
  EXPECT_EQ(console(record).find("\n\n\n"), std::string::npos);
  EXPECT_NE(console(record).find("first\nsecond\n"), std::string::npos);
}

TEST(Console, TheSummarySaysInWordsWhatTheRunConcluded) {
  const std::string text = console(example_record());
  EXPECT_NE(
      text.find(
          "5 of 13 claims broken in 1 min 23 s. Verdicts: 1 pass, but fail expected; 1 error;"),
      std::string::npos);
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
  const bool verbose = *rc::gen::arbitrary<bool>();
  const std::string text = console(record, {.width = width, .verbose = verbose});
  for (const std::string& line : lines(text)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(clean(text) == text);
}

TEST(Console, NeverCutsTheCommandThatRepeatsATest) {
  Record record = example_record();
  const std::string claim = "'mean(" + std::string(200, 'x') + ") == analytic'";
  record.suites[0].tests[0].replay = "assay check " + claim + " --seed 1";
  const std::string text = console(record, {.width = 80, .verbose = true});
  EXPECT_NE(text.find(claim + " \\\n"), text.npos);
}

}  // namespace
}  // namespace assay::reports
