#include "reports/words/text.h"

#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

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
