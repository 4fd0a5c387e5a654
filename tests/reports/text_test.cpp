#include "reports/words/text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/prelude.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

TEST(Clean, KeepsValidTextWithLineFeedsAndTabs) {
  const std::string text = "a\n\tπ ≤ 光線 \U0001F3B2";
  EXPECT_EQ(clean(text), text);
}

TEST(Clean, ReplacesControlsAndTurnsWindowsLineEndsIntoOurs) {
  EXPECT_EQ(clean("\x1b[31m"), "\uFFFD[31m");
  EXPECT_EQ(clean(std::string_view("a\0b\x7f", 4)), "a\uFFFDb\uFFFD");
  EXPECT_EQ(clean("\xC2\x9B"), "\uFFFD");  // the one-character form of ESC [
  EXPECT_EQ(clean("a\r\nb\rc"), "a\nb\uFFFDc");
  EXPECT_EQ(clean("\u202E\u2066\u2028"), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(clean("\xEF\xBF\xBE\xEF\xBF\xBF"), "\uFFFD\uFFFD");  // U+FFFE, U+FFFF
}

// Table 3-7 of the Unicode standard: the only well-formed byte sequences.
TEST(Clean, RepairsEveryKindOfIllFormedUtf8) {
  EXPECT_EQ(clean("\xC3"), "\uFFFD");                                // cut short
  EXPECT_EQ(clean("\xC3("), "\uFFFD(");                              // no continuation
  EXPECT_EQ(clean("\xC0\xAF"), "\uFFFD\uFFFD");                      // overlong
  EXPECT_EQ(clean("\xE0\x80\xAF"), "\uFFFD\uFFFD\uFFFD");            // overlong
  EXPECT_EQ(clean("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");            // surrogate
  EXPECT_EQ(clean("\xF4\x90\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD");  // above U+10FFFF
  EXPECT_EQ(clean("\x80"), "\uFFFD");
}

TEST(Clean, EveryCodePointSurvivesDecodingAndEncoding) {
  for (char32_t c = 0; c <= 0x10FFFF; ++c) {
    if (c >= 0xD800 && c <= 0xDFFF) continue;
    std::string text;
    append_code_point(text, c);
    std::size_t position = 0;
    ASSERT_EQ(next_code_point(text, position), c);
    ASSERT_EQ(position, text.size());
  }
}

RC_GTEST_PROP(Clean, IsIdempotent, ()) {
  const std::string once = clean(*any_text());
  RC_ASSERT(clean(once) == once);
}

TEST(Escape, XmlLosesNoCharacterOfTheMarkup) {
  EXPECT_EQ(escape_xml("<a b=\"c\" d='e'>&]]>"),
            "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;]]&gt;");
  EXPECT_EQ(escape_attribute("a\nb\tc"), "a&#10;b&#9;c");
}

TEST(Escape, MarkdownStaysInItsTableCell) {
  EXPECT_EQ(escape_markdown("a|b *c* _d_ `e` <f> @me #1\nx"),
            "a\\|b \\*c\\* \\_d\\_ \\`e\\` &lt;f&gt; &#64;me &#35;1 x");
}

TEST(Cap, CutsBetweenCharactersAndSaysSo) {
  EXPECT_EQ(cap("short", 64), "short");
  std::string text;
  for (int i = 0; i < 100; ++i) text += "光";
  for (std::size_t bytes = 0; bytes < 300; ++bytes) {
    const std::string cut = cap(text, bytes);
    ASSERT_LE(cut.size(), bytes);
    ASSERT_EQ(clean(cut), cut);
  }
  EXPECT_NE(cap(text, 200).find("[cut: 300 bytes in all"), std::string::npos);
}

}  // namespace
}  // namespace assay::reports
