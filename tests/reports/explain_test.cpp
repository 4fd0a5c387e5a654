#include "reports/report_formats.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Explain, AFindingOfLawsIsASentence) {
  reports::Test test = failing();
  test.image->winner = {.statistic = "the mean is larger in a",
                        .place = "the whole image of red",
                        .width = test.image->width,
                        .height = test.image->height,
                        .component = "red"};
  const std::string text = explain(example_record().suites[0], test, 1000);
  EXPECT_THAT(text,
              HasSubstr("The claim is wrong. The whole image of red: the mean is larger in a"));
  EXPECT_THAT(text, Not(HasSubstr("The range"))) << "there is none in the sentence";
}

TEST(Explain, AnUndecidedTestHasTheLineToAdd) {
  const Suite suite = example_record().suites[0];
  reports::Test test = undecided();
  test.message = "about 1100 secondaries would decide; write `secondaries: 17`";
  test.advice = {.key = "secondaries", .value = "1100"};
  const std::string text = explain(suite, test, 1000);
  EXPECT_THAT(text, HasSubstr("The observations do not suffice to say whether the claim holds."));
  EXPECT_THAT(text, HasSubstr("What to do next\n  write into the test:\n    secondaries: 1100\n"));
  test.file.clear();  // of the command line
  test.replay = "assay check 'mean(a) == 1' --secondaries 50 --seed 1";
  EXPECT_THAT(explain(suite, test, 1000),
              HasSubstr("  to decide:\n"
                        "    assay check 'mean(a) == 1' --secondaries 1100 --seed 1\n"));
  test.advice = {.words = "give about 1100 rows in all"};
  EXPECT_THAT(explain(suite, test, 1000),
              HasSubstr("  to decide:\n    give about 1100 rows in all\n"));
}

// A command to paste is whole.
RC_GTEST_PROP(Explain, FitsItsWidth, ()) {
  Record record = random_record();
  for (Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) {
      test.replay.clear();
      test.advice.reset();
      const std::string text = explain(suite, test, 60);
      RC_ASSERT(clean(text) == text);
      for (const std::string& line : lines(text)) RC_ASSERT(columns(line) <= 60);
    }
  }
}

}  // namespace
}  // namespace assay::reports
