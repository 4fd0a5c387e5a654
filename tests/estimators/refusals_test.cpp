// Each case of tests/tables/refusals.txt.

#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

const std::string data = ASSAY_SOURCE_DIR "/suites/data";

std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != text.npos; from = at + separator.size())
    parts.push_back(text.substr(from, at - from));
  parts.push_back(text.substr(from));
  return parts;
}

TEST(Refusals, SayWhatIsWrong) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/refusals.txt");
  std::vector<std::pair<std::string, std::string>> names;
  std::string plugin;
  int cases = 0;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    SCOPED_TRACE("line " + std::to_string(++number) + ": " + line);
    if (line.empty() || line.starts_with('#')) continue;
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
      for (std::size_t at; (at = line.find(name->first, 1)) != line.npos;)
        line.replace(at, name->first.size(), name->second);
    }
    if (line.starts_with('$')) {
      const auto parts = split(line, " = ");
      names.emplace_back(parts.at(0), parts.at(1));
    } else if (!line.starts_with(' ')) {
      plugin = line;
    } else {
      const auto parts = split(line.substr(2), " =>");
      const std::string said =
          thrown<InputError>([&] { draws::prepare(plugin, parts.at(0), data); });
      EXPECT_NE(said, thrown([] {}));
      for (const std::string& words : split(parts.at(1), " & ")) {
        EXPECT_THAT(said, HasSubstr(words.substr(words.starts_with(' '))));
      }
      ++cases;
    }
  }
  EXPECT_GT(cases, 140);
}

}  // namespace
}  // namespace assay
