#include "tests/estimators/prelude.h"
// Each case of tests/tables/refusals.txt.

namespace assay {
namespace {

TEST(Refusals, SayWhatIsWrong) {
  const std::vector<ParameterRow> rows = parameter_rows("refusals.txt");
  for (const auto& [plugin, text] : rows) {
    SCOPED_TRACE(plugin + ": " + text);
    const auto parts = split(text, " =>");
    const std::string said = draws::refusal(plugin, parts.at(0));
    EXPECT_NE(said, thrown([] {}));
    for (const std::string& words : split(parts.at(1), " & ")) {
      EXPECT_THAT(said, HasSubstr(words.substr(words.starts_with(' '))));
    }
  }
  EXPECT_GT(rows.size(), 140U);
}

}  // namespace
}  // namespace assay
