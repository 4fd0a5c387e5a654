#include "reports/words/columns.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <wchar.h>

#include <clocale>

#include "reports/words/text.h"
#include "tests/prelude.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

// The C library knows the width of every character: an independent table.
TEST(Columns, NeverCountsFewerThanTheCLibrary) {
  ASSERT_NE(std::setlocale(LC_CTYPE, "C.UTF-8"), nullptr);
  for (char32_t c = 0x20; c <= 0x10FFFF; ++c) {
    const int width = wcwidth(static_cast<wchar_t>(c));
    if (width > 0) {
      ASSERT_GE(columns(c), width) << std::hex << static_cast<std::uint32_t>(c);
    }
  }
  std::setlocale(LC_CTYPE, "C");
}

TEST(Columns, CountsWhatATerminalShows) {
  EXPECT_EQ(columns("pass"), 4);
  EXPECT_EQ(columns("größe"), 5);
  EXPECT_EQ(columns("光線"), 4);
  EXPECT_EQ(columns("e\u0301"), 1);
  EXPECT_EQ(columns("✓✗…"), 3);
}

TEST(Columns, ShorteningEndsInAnEllipsis) {
  EXPECT_EQ(shorten("estimator", 9), "estimator");
  EXPECT_EQ(shorten("estimator", 6), "estim…");
  EXPECT_EQ(shorten("光線追跡", 4), "光…");
  EXPECT_EQ(shorten("abc", 0), "");
}

TEST(Columns, WrapsAtSpacesAndKeepsLineFeeds) {
  EXPECT_EQ(wrap("one two three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrap("a\n\nb", 7), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(wrap("abcdefghij", 4), (std::vector<std::string>{"abcd", "efgh", "ij"}));
  EXPECT_EQ(wrap("", 4), (std::vector<std::string>{""}));
}

TEST(Columns, CommandsCanBePastedFromSeveralLines) {
  EXPECT_EQ(wrap_command("assay check 'a b c' --seed 1", 16),
            (std::vector<std::string>{"assay check \\", "'a b c' --seed \\", "1"}));
  EXPECT_EQ(wrap_command("assay run", 80), (std::vector<std::string>{"assay run"}));
  EXPECT_EQ(wrap_command("a --filter 'it'\\''s so'", 12),
            (std::vector<std::string>{"a --filter \\", "'it'\\''s so'"}));
}

RC_GTEST_PROP(Columns, WrappedLinesFit, ()) {
  const int width = *rc::gen::inRange(2, 40);
  const std::string text = clean(*any_text());
  for (const std::string& line : wrap(text, width)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(columns(shorten(one_line(text), width)) <= width);
}

RC_GTEST_PROP(Columns, WrappedCommandsAreWholeAndTheirLinesFit, ()) {
  const int width = *rc::gen::inRange(4, 40);
  const auto words = *rc::gen::container<std::vector<std::string>>(
      rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange('a', '~'))));
  std::string command;
  for (const std::string& word : words) {
    if (word.find_first_of("'\"\\") == word.npos) command += (command.empty() ? "" : " ") + word;
  }
  std::string joined;
  for (std::string line : wrap_command(command, width)) {
    const bool goes_on = line.ends_with(" \\");
    const std::string words_of = goes_on ? line.substr(0, line.size() - 2) : line;
    RC_ASSERT(columns(line) <= width || words_of.find(' ') == words_of.npos);
    joined += (joined.empty() ? "" : " ") + words_of;
  }
  RC_ASSERT(joined == command);
}

TEST(Columns, ALongWordIsPartedWhereAClaimMayBe) {
  EXPECT_EQ(wrap("distribution(triangle_hemisphere.direction)", 40),
            (std::vector<std::string>{"distribution(triangle_hemisphere.", "direction)"}));
  // A decimal point is no such place.
  EXPECT_EQ(wrap("mean==0.48104690731593186", 20),
            (std::vector<std::string>{"mean==0.481046907315", "93186"}));
}

}  // namespace
}  // namespace assay::reports
