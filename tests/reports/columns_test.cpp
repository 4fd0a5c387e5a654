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

RC_GTEST_PROP(Columns, WrappedLinesFit, ()) {
  const int width = *rc::gen::inRange(2, 40);
  const std::string text = clean(*any_text());
  for (const std::string& line : wrap(text, width)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(columns(shorten(one_line(text), width)) <= width);
}

TEST(Columns, ALineEndsNotBetweenANumberAndItsPerCent) {
  EXPECT_EQ(wrap("about 1.5 % off", 9), (std::vector<std::string>{"about", "1.5 % off"}));
  EXPECT_EQ(wrap("about 1.5 % off", 11), (std::vector<std::string>{"about 1.5 %", "off"}));
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

}  // namespace
}  // namespace assay::reports
