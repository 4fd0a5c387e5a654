#include "reports/report_formats.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

reports::Test failed(const std::string& id, double log10_p = -3) {
  reports::Test test = judged(Verdict::fail);
  test.id = id;
  test.channels = {{.name = "value", .log10_p = log10_p}};
  return test;
}

TEST(Annotations, AreNoneWhereAllIsWell) {
  EXPECT_EQ(annotations(record_of({judged(Verdict::pass)})) + annotations({}), "");
}

TEST(Annotations, EscapeWhatWouldEndACommand) {
  reports::Test test = failed("a/100%: a, b");
  test.message = "50 %\nsecond: line, with ::error::";
  const std::string text = annotations(record_of({test}));
  EXPECT_EQ(lines(text).size(), 1);
  EXPECT_THAT(text, HasSubstr("title=fail%3A a/100%25%3A a%2C b::"));
  EXPECT_THAT(text, HasSubstr("50 %25%0Asecond: line, with ::error::"));
}

TEST(Annotations, AreTheWorstNineAndACountOfTheRest) {
  std::vector<reports::Test> tests;
  for (int i = 1; i <= 12; ++i) tests.push_back(failed("a/" + std::to_string(i), -i));
  tests.push_back(judged(Verdict::error));
  const auto all = lines(annotations(record_of(tests)));
  ASSERT_EQ(all.size(), most_annotations);
  EXPECT_THAT(all[0], HasSubstr("suite/name::"));
  EXPECT_THAT(all[1], HasSubstr("a/12::"));
  EXPECT_THAT(all[8], HasSubstr("a/5::"));
  EXPECT_THAT(all[9], HasSubstr("4 more are not shown here"));
  tests.resize(10);
  const auto ten = lines(annotations(record_of(tests)));
  ASSERT_EQ(ten.size(), most_annotations);
  EXPECT_THAT(ten[9], Not(HasSubstr("more")));
}

RC_GTEST_PROP(Annotations, OfAnyRecordAreCommandsOneALineAndFewEnough, ()) {
  const auto all = lines(annotations(random_record()));
  const auto of_kind = [&](const char* kind) {
    return std::count_if(all.begin(), all.end(),
                         [&](const std::string& line) { return line.starts_with(kind); });
  };
  RC_ASSERT(of_kind("::error ") <= 10);
  RC_ASSERT(of_kind("::warning ") <= 10);
  RC_ASSERT(static_cast<std::size_t>(of_kind("::error ") + of_kind("::warning ")) == all.size());
  for (const std::string& line : all) RC_ASSERT(line.find('\r') == std::string::npos);
}

}  // namespace
}  // namespace assay::reports
