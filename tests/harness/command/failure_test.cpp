#include "harness/base/terminal.h"
#include "harness/command/program.h"
#include "harness/suite/suite.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

const std::string bad_suite = std::string(ASSAY_SOURCE_DIR) + "/tests/suites/bad_unknown_key.yaml";

std::string failure_of(const std::string& file) {
  try {
    load_suite(file);
    return "";
  } catch (const InputError& e) {
    return failure_text(e, "");
  }
}

TEST(Failure, ShowsPlaceLineAndCaretOfASuite) {
  const std::string text = failure_of(bad_suite);
  EXPECT_TRUE(text.starts_with("assay: " + bad_suite + ":3:1:")) << text;
  EXPECT_TRUE(text.ends_with("did you mean `tests`?\n  test:\n  ^\n")) << text;
}

TEST(Failure, ShowsTheClaimOfTheCommandLine) {
  EXPECT_EQ(failure_text(InputError({"claim", 1, 6}, "no such estimator"), "mean(x) == 1"),
            "assay: claim:1:6: no such estimator\n  mean(x) == 1\n       ^\n");
  EXPECT_EQ(failure_text(InputError({"claim", 1, 6}, "of Assay's own claim"), ""),
            "assay: of Assay's own claim\n");
}

TEST(Failure, IsInLinesOfEightyColumnsThatBreakNothingToPaste) {
  const std::string part = "seventy columns are no room for this and that and what is yet to come";
  EXPECT_EQ(in_lines(part + " now"), "assay: " + part + " now\n");
  EXPECT_EQ(in_lines(part + " soon"), "assay: " + part + "\n       soon\n");
  EXPECT_EQ(in_lines(part + " `a b`, as it is"), "assay: " + part + "\n       `a b`, as it is\n");
  EXPECT_EQ(in_lines(part + " `a b"), "assay: " + part + " `a\n       b\n");
  const std::string path(200, 'x');
  EXPECT_EQ(in_lines("no " + path + " here"), "assay: no\n       " + path + "\n       here\n");
  EXPECT_EQ(in_lines("it said:\n  this"), "assay: it said:\n  this\n");
}

TEST(Failure, ShowsTheLineThatItWasGiven) {
  EXPECT_EQ(failure_text(InputError({"standard input", 7, 3}, "odd", "1 x"), ""),
            "assay: standard input:7:3: odd\n  1 x\n    ^\n");
}

TEST(Failure, HidesWhatATerminalMustNotMeet) {
  const std::string hidden = "\xef\xbf\xbd";
  EXPECT_EQ(failure_text(InputError({"a\x1b.txt", 1, 5}, "`\x07\x9b`", "\x1b[\x80 x\x7f"), ""),
            "assay: a" + hidden + ".txt:1:5: `" + hidden + hidden + "`\n  " + hidden + "[" +
                hidden + " x" + hidden + "\n      ^\n");
}

TEST(Failure, IsOneLineWithoutAPlace) {
  EXPECT_EQ(failure_text(InputError({}, "--seed is wrong"), "mean(x) == 1"),
            "assay: --seed is wrong\n");
  EXPECT_EQ(failure_text(InputError({"/not/there.yaml", 3, 1}, "odd"), ""),
            "assay: /not/there.yaml:3:1: odd\n");
}

TEST(Failure, PointsAtNothingInAnEmptyFile) {
  const Folder folder;
  for (const char* text : {"", "\n \n"}) {
    const std::string file = folder.write("empty.yaml", text);
    EXPECT_EQ(failure_of(file), in_lines(file + ":1:1: the file is empty"));
  }
}

}  // namespace
}  // namespace assay::harness
