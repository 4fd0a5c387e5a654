#include "reports/formats/explain.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/words/columns.h"
#include "reports/words/text.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

std::string explained(const char* name) {
  for (const Suite& suite : example_record().suites) {
    for (const reports::Test& test : suite.tests) {
      if (test.name == name) return explain(suite, test, 1000);
    }
  }
  ADD_FAILURE() << name;
  return "";
}

TEST(Explain, AFailSaysWhatIsWrongHowUnlikelyAndHowToSeeIt) {
  const std::string text = explained("mean(winners) == mean(hemisphere)");
  EXPECT_THAT(text, HasSubstr("The claim is wrong. x 2-3, y 1-2 of green is 1.62"));
  EXPECT_THAT(text, HasSubstr("The chance of such data, if nothing is wrong, is less than 1 in a"));
  EXPECT_THAT(text, HasSubstr("  again:\n    assay replay run.json"));
  EXPECT_THAT(text, HasSubstr("--report html=difference.html"));
}

TEST(Explain, AFindingOfLawsIsASentence) {
  Suite suite = example_record().suites[0];
  for (reports::Test& test : suite.tests) {
    if (!test.image || test.verdict != Verdict::fail) continue;
    test.image->winner = {.statistic = "the mean is larger in a",
                          .place = "the whole image, z = +7.9",
                          .width = test.image->width,
                          .height = test.image->height,
                          .component = "red"};
    EXPECT_THAT(explain(suite, test, 1000),
                HasSubstr("The claim is wrong. The whole image of red: the mean is larger in a"));
  }
}

TEST(Explain, APassSaysWhatItExcludes) {
  const std::string text = explained("mean(area) == analytic");
  EXPECT_THAT(text, HasSubstr("Nothing speaks against the claim. mean(area) is 0.031"));
  EXPECT_THAT(explained("variance(area) < variance(hemisphere)"), HasSubstr("The claim is shown."));
}

TEST(Explain, APlantedBugIsCaughtOrNeedsASmallerEffect) {
  EXPECT_THAT(explained("forgetting the receiver's cosine is caught"),
              HasSubstr("This is as the suite expects."));
  const std::string missed = explained("sharing a seed is caught");
  EXPECT_THAT(missed, HasSubstr("The planted bug was not caught."));
  EXPECT_THAT(missed, HasSubstr("  write into the test:\n    detect: 0.25%\n"));
}

TEST(Explain, AnUndecidedTestHasTheLineToAdd) {
  Suite suite = example_record().suites[0];
  reports::Test& test = suite.tests[5];
  ASSERT_EQ(test.verdict, Verdict::inconclusive);
  test.message = "about 1100 secondaries would decide; write `secondaries: 1100`";
  const std::string text = explain(suite, test, 1000);
  EXPECT_THAT(text, HasSubstr("Too few samples were drawn to say whether the claim holds."));
  EXPECT_THAT(text, HasSubstr("What to do next\n  write into the test:\n    secondaries: 1100\n"));
  test.message = "about 1100 secondaries would decide; write `--secondaries 1100`";
  EXPECT_THAT(explain(suite, test, 1000),
              HasSubstr("  give the command:\n    --secondaries 1100\n"));
}

TEST(Explain, AnInvalidTestSaysWhatWasMeasured) {
  const std::string text = explained("variance(heavy) <= 0.07");
  EXPECT_THAT(text, HasSubstr("Nothing was decided"));
  EXPECT_THAT(text, HasSubstr("The fourth moment may not exist"));
  EXPECT_THAT(text, HasSubstr("Measured: tail index is red (0.41, limit 0.25)"));
  EXPECT_THAT(text, Not(HasSubstr("False alarms")));
}

TEST(Explain, AnErrorAndATestThatWasNotRunSayWhy) {
  EXPECT_THAT(explained("mean(rare_nan) == analytic"),
              HasSubstr("drawing them failed. 16384 of 16384 observations are not finite"));
  EXPECT_THAT(explained("mean(solid_angle) == analytic"),
              HasSubstr("The claim was not tested. Belongs to another shard."));
}

// A command to paste is whole.
RC_GTEST_PROP(Explain, FitsItsWidth, ()) {
  Record record = random_record();
  for (Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) {
      test.replay.clear();
      test.message.clear();
      const std::string text = explain(suite, test, 60);
      RC_ASSERT(clean(text) == text);
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) RC_ASSERT(columns(line) <= 60);
    }
  }
}

}  // namespace
}  // namespace assay::reports
