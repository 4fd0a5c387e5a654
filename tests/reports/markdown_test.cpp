#include "reports/report_formats.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Markdown, ALargeRecordStaysBelowTheLimitAndSaysWhatIsMissing) {
  Record record = example_record();
  Suite& suite = record.suites[0];
  const std::vector<reports::Test> tests = suite.tests;
  while (suite.tests.size() < 9000)
    suite.tests.insert(suite.tests.end(), tests.begin(), tests.end());
  const std::string text = markdown(record);
  EXPECT_LE(text.size(), markdown_limit);
  EXPECT_GT(text.size(), markdown_limit / 2);
  EXPECT_THAT(text, HasSubstr("Cut to fit: "));
}

// The lines outside fenced code, where a replay command may look like anything.
std::vector<std::string> lines_outside_code(const std::string& text) {
  std::vector<std::string> result;
  std::string fence;
  for (const std::string& line : lines(text)) {
    if (fence.empty() && line.rfind("```", 0) == 0) {
      fence = line.substr(0, line.find_first_not_of('`'));
    } else if (line == fence) {
      fence.clear();
    } else if (fence.empty()) {
      result.push_back(line);
    }
  }
  return result;
}

auto unescaped_bars(const std::string& line) {
  return std::ranges::count(std::regex_replace(line, std::regex(R"(\\.)"), ""), '|');
}

/// Statements have three cells, tests five; a row has as many as the one above it.
RC_GTEST_PROP(Markdown, EveryRowOfATableHasTheSameCells, ()) {
  std::ptrdiff_t above = 0;
  for (const std::string& line : lines_outside_code(markdown(random_record()))) {
    const auto bars = line.starts_with("| ") ? unescaped_bars(line) : 0;
    if (bars > 0) RC_ASSERT(bars == 4 || bars == 6);
    if (bars > 0 && above > 0) RC_ASSERT(bars == above);
    if (!line.starts_with("|---")) above = bars;
  }
}

RC_GTEST_PROP(Markdown, HoldsNoControlCharacterAndFitsAnyLimit, ()) {
  const auto limit = *rc::gen::inRange<std::size_t>(300, 4000);
  const std::string text = markdown(random_record(), limit);
  RC_ASSERT(clean(text) == text);
  RC_ASSERT(text.size() <= limit);
}

}  // namespace
}  // namespace assay::reports
