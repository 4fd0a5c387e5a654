#include <gtest/gtest.h>

#include "estimators/catalogue.h"
#include "harness/command/commands.h"

namespace assay::harness {
namespace {

TEST(List, PrintsEveryPluginOnALine) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_plugins(), 0);
  std::fflush(stdout);
  std::string expected;
  for (const Entry& entry : catalogue()) expected += entry.information.name + "\n";
  EXPECT_EQ(testing::internal::GetCapturedStdout(), expected);
}

TEST(List, PrintsEveryTestOnALineInTheOrderOfTheSuites) {
  std::vector<Suite> suites(2);
  suites[0].tests.resize(2);
  suites[0].tests[0].id = "a/mean(x) == 1";
  suites[0].tests[1].id = "a/named";
  suites[1].tests.resize(1);
  suites[1].tests[0].id = "b/other";
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_tests(suites, {}), 0);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a/mean(x) == 1\na/named\nb/other\n");
  testing::internal::CaptureStdout();
  EXPECT_EQ(list_tests(suites, {.filters = {"-*/named"}}), 0);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a/mean(x) == 1\nb/other\n");
}

TEST(List, SaysSoWhereNoTestIsSelected) {
  std::vector<Suite> suites(1);
  suites[0].tests.resize(1);
  suites[0].tests[0].id = "a/named";
  testing::internal::CaptureStderr();
  EXPECT_EQ(list_tests(suites, {.tags = {"slow"}}), 4);
  std::fflush(stderr);
  EXPECT_TRUE(testing::internal::GetCapturedStderr().starts_with("assay: --tag slow: "));
}

}  // namespace
}  // namespace assay::harness
