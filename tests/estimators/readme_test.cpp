#include "tests/prelude.h"

namespace assay {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(ASSAY_SOURCE_DIR "/estimators/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The file is built as part of the library: includes, namespaces and all.
TEST(EstimatorsReadme, ShowsAWholeFileThatIsCompiled) {
  const std::string readme = text_of("README.md");
  const std::string fence = "```cpp\n";
  const std::size_t begin = readme.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t from = begin + fence.size();
  const std::string example = readme.substr(from, readme.find("```", from) - from);
  EXPECT_EQ(example, text_of("analytic/dart_throwing.cpp"));
  EXPECT_THAT(example, testing::HasSubstr("#include"));
}

}  // namespace
}  // namespace assay
