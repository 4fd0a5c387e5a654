#include "reports/formats/base64.h"

#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

RC_GTEST_PROP(Base64, ReadsBack, (const std::vector<std::uint8_t>& bytes)) {
  RC_ASSERT(from_base64(base64(bytes)) == bytes);
}

TEST(Base64, FloatsAreLittleEndian) {
  EXPECT_EQ(base64(bytes_of(std::vector<float>{1.0f})), "AACAPw==");
  const std::vector<float> values = {-0.0f, 1e-45f, std::numeric_limits<float>::infinity(), 3.25f};
  EXPECT_EQ(floats_of(bytes_of(values)), values);
}

}  // namespace
}  // namespace assay::reports
