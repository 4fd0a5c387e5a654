#include "harness/failure.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/suite.h"

namespace assay::harness {
namespace {

const std::string bad_suite = std::string(ASSAY_SOURCE_DIR) + "/tests/suites/bad_unknown_key.yaml";

std::string failure_of(const std::string& file) {
  try {
    load_suite(file);
  } catch (const InputError& e) {
    return failure_text(e, "");
  }
  return "";
}

TEST(Failure, ShowsPlaceLineAndCaretOfASuite) {
  EXPECT_EQ(failure_of(bad_suite), bad_suite +
                                       ":3:1: unknown key `test` of a suite; did you mean "
                                       "`tests`?\n  test:\n  ^\n");
}

TEST(Failure, ShowsTheClaimOfTheCommandLine) {
  EXPECT_EQ(failure_text(InputError({"claim", 1, 6}, "no such estimator"), "mean(x) == 1"),
            "claim:1:6: no such estimator\n  mean(x) == 1\n       ^\n");
}

TEST(Failure, IsOneLineWithoutAPlace) {
  EXPECT_EQ(failure_text(InputError({}, "--seed is wrong"), "mean(x) == 1"), "--seed is wrong\n");
  EXPECT_EQ(failure_text(InputError({"/not/there.yaml", 3, 1}, "odd"), ""),
            "/not/there.yaml:3:1: odd\n");
}

TEST(Failure, PointsAtNothingInAnEmptyFile) {
  const std::string file = testing::TempDir() + "empty-of-failure-test.yaml";
  for (const char* text : {"", "\n \n"}) {
    std::ofstream(file, std::ios::trunc) << text;
    EXPECT_EQ(failure_of(file), file + ":1:1: the file is empty\n");
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace assay::harness
