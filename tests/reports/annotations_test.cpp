#include "reports/formats/annotations.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "random_record.h"
#include "tests/prelude.h"

namespace assay::reports {
namespace {

assay::reports::Test test(const std::string& id, Verdict verdict, double log10_p = -3) {
  assay::reports::Test t;
  t.id = t.name = id;
  t.file = "suites/a.yaml";
  t.line = 12;
  t.verdict = verdict;
  t.channels = {{.name = "value", .log10_p = log10_p}};
  t.ok = verdict == Verdict::pass;
  return t;
}

Record of(const std::vector<assay::reports::Test>& tests) {
  Record record;
  record.suites.push_back({.name = "a", .tests = tests});
  return record;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    all.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return all;
}

TEST(Annotations, AreNoneWhereAllIsWell) {
  EXPECT_EQ(annotations(of({test("a/x", Verdict::pass)})), "");
  EXPECT_EQ(annotations({}), "");
}

TEST(Annotations, PointAtTheLineOfTheSuite) {
  const auto all = lines(annotations(of({test("a/x", Verdict::fail)})));
  ASSERT_EQ(all.size(), 1);
  EXPECT_THAT(all[0], StartsWith("::error file=suites/a.yaml,line=12,title=fail%3A a/x::"));
}

TEST(Annotations, OfWhatIsUndecidedAreWarnings) {
  EXPECT_THAT(annotations(of({test("a/x", Verdict::inconclusive)})), StartsWith("::warning "));
}

TEST(Annotations, EscapeWhatWouldEndACommand) {
  assay::reports::Test t = test("a/100%: a, b", Verdict::fail);
  t.message = "50 %\nsecond: line, with ::error::";
  const std::string text = annotations(of({t}));
  EXPECT_EQ(lines(text).size(), 1);
  EXPECT_THAT(text, HasSubstr("title=fail%3A a/100%25%3A a%2C b::"));
  EXPECT_THAT(text, HasSubstr("50 %25%0Asecond: line, with ::error::"));
}

TEST(Annotations, AreTheWorstNineAndACountOfTheRest) {
  std::vector<assay::reports::Test> tests;
  for (int i = 1; i <= 12; ++i) {
    tests.push_back(test("a/" + std::to_string(i), Verdict::fail, -i));
  }
  tests.push_back(test("a/error", Verdict::error));
  const auto all = lines(annotations(of(tests)));
  ASSERT_EQ(all.size(), most_annotations);
  EXPECT_THAT(all[0], HasSubstr("a/error::"));
  EXPECT_THAT(all[1], HasSubstr("a/12::"));
  EXPECT_THAT(all[8], HasSubstr("a/5::"));
  EXPECT_THAT(all[9], HasSubstr("4 more are not shown here"));
  tests.resize(10);
  const auto ten = lines(annotations(of(tests)));
  ASSERT_EQ(ten.size(), most_annotations);
  EXPECT_THAT(ten[9], Not(HasSubstr("more")));
}

TEST(Annotations, NameAnAlarmOfTheLedger) {
  Record record;
  record.ledger.series.push_back({.test = "a/x", .alarm = true, .since = "2026-01-01"});
  EXPECT_THAT(annotations(record), StartsWith("::error title=alarm of the ledger%3A a/x::"));
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
