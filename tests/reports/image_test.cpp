// Images in reports: base64 and the words for them.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "example_record.h"
#include "reports/formats/base64.h"
#include "reports/formats/console.h"
#include "reports/formats/junit.h"
#include "reports/formats/markdown.h"
#include "tests/prelude.h"

namespace assay::reports {
namespace {

std::string text_of(std::string_view bytes) {
  return base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(text_of(""), "");
  EXPECT_EQ(text_of("f"), "Zg==");
  EXPECT_EQ(text_of("fo"), "Zm8=");
  EXPECT_EQ(text_of("foo"), "Zm9v");
  EXPECT_EQ(text_of("foob"), "Zm9vYg==");
  EXPECT_EQ(text_of("foobar"), "Zm9vYmFy");
}

RC_GTEST_PROP(Base64, ReadsBack, (const std::vector<std::uint8_t>& bytes)) {
  RC_ASSERT(from_base64(base64(bytes)) == bytes);
}

TEST(Base64, RefusesWhatIsNone) {
  for (const char* text : {"Zg=", "Z", "Zg==Zg==", "Zm9\n", "Z===", "====", "Zm9-"}) {
    EXPECT_FALSE(from_base64(text)) << text;
  }
}

TEST(Base64, FloatsAreLittleEndian) {
  EXPECT_EQ(bytes_of(std::vector<float>{1.0f}), (std::vector<std::uint8_t>{0, 0, 0x80, 0x3f}));
  const std::vector<float> values = {-0.0f, 1e-45f, std::numeric_limits<float>::infinity(), 3.25f};
  EXPECT_EQ(floats_of(bytes_of(values)), values);
}

TEST(ImagePreview, EveryFormatNamesTheCell) {
  const Record record = example_record();
  for (const std::string& text : {junit(record), console(record, {.detail = 2})}) {
    EXPECT_NE(text.find("columns 2-3, rows"), std::string::npos) << text;
  }
  EXPECT_NE(markdown(record).find("columns 2-3, rows 1-2 of green"), std::string::npos);
}

}  // namespace
}  // namespace assay::reports
