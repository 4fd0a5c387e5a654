// Claims of every kind, from YAML to verdict and message: the rows of tests/tables/verdicts.txt.

#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

/// Of one claim.
struct Row {
  std::string verdict;  ///< or `refused`
  std::string claim;
  std::vector<std::string> words;
};

struct Section {
  std::string suite;
  std::vector<Row> rows;
};

std::map<std::string, Section> sections() {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/verdicts.txt");
  std::map<std::string, Section> all;
  Section* section = nullptr;
  bool in_suite = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("=== ")) {
      section = &all[line.substr(4)];
      in_suite = true;
    } else if (line == "---") {
      in_suite = false;
    } else if (in_suite) {
      section->suite += line == "  -" ? "  - " : line + "\n";
    } else if (line.starts_with("    ")) {
      section->rows.back().words.push_back(line.substr(4));
    } else if (!line.empty() && !line.starts_with('#')) {
      const std::size_t space = line.find(' ');
      section->rows.push_back({line.substr(0, space), line.substr(space + 1), {}});
    }
  }
  return all;
}

class Verdicts : public TestWithParam<const char*> {};

TEST_P(Verdicts, AreThoseOfTheTable) {
  const Section section = sections().at(GetParam());
  EXPECT_GE(section.rows.size(), 7U);
  for (const Row& row : section.rows) {
    const std::string text = section.suite + row.claim + "\n";
    reports::Test test;
    const std::string why = refusal([&] { test = run_test(text); });
    const bool refused = !why.starts_with("(nothing");
    EXPECT_EQ(refused ? "refused" : to_string(test.verdict), row.verdict)
        << row.claim << ": " << (refused ? why : test.message);
    for (const std::string& words : row.words) {
      const bool present = !words.starts_with("! ");
      EXPECT_EQ((refused ? why : test.message).find(present ? words : words.substr(2)) !=
                    std::string::npos,
                present)
          << row.claim << ": " << (refused ? why : test.message) << "\n  " << words;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfClaims, Verdicts,
                         Values("claims", "laws", "words", "pictures", "questions"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace assay::harness
