// Claims of every kind, from YAML to verdict and message: the rows of tests/tables/verdicts.txt.

#include "tests/harness/prelude.h"
#include "tests/harness/recorded_rows.h"
#include "tests/harness/table.h"

namespace assay::harness {
namespace {

struct Expected {
  std::string verdict;  ///< or `refused`
  bool ok;              ///< that the test is as expected
  std::string method;   ///< "": any
  std::string claim;
};

/// VERDICT [expected|unexpected] [by METHOD] CLAIM
Expected expected_of(const std::string& text) {
  std::smatch parts;
  static const std::regex form(R"((\w+)( expected| unexpected)?(?: by (\S+))? (\{.*|claim:.*))");
  if (!std::regex_match(text, parts, form)) throw std::invalid_argument(text);
  const bool ok = parts[2].matched ? parts[2] == " expected" : parts[1] == "pass";
  return {parts[1], ok, parts[3], parts[4]};
}

class Verdicts : public TestWithParam<ClaimSection> {};

TEST_P(Verdicts, AreThoseOfTheTable) {
  EXPECT_GE(GetParam().rows.size(), 2U);
  for (const ClaimRow& row : GetParam().rows) {
    const Expected expected = expected_of(row.text);
    const Workplace place;
    for (const auto& [file, numbers] : row.files) place.write(file, file_of(numbers));
    const std::string file = place.write("suite.yaml", suite_with(GetParam(), expected.claim));
    reports::Test test;
    const std::string why =
        refusal([&] { test = run_files({file}, {.threads = 1}).suites[0].tests.at(0); });
    const bool refused = !why.starts_with("(nothing");
    const std::string said = refused ? why : test.message;
    EXPECT_EQ(refused ? "refused" : to_string(test.verdict), expected.verdict)
        << row.text << ": " << said;
    EXPECT_EQ(test.ok, expected.ok) << row.text;
    if (!expected.method.empty()) {
      EXPECT_EQ(test.method, expected.method) << row.text;
    }
    for (const std::string& words : row.words) {
      if (words.starts_with("rows: ")) {
        std::vector<std::uint64_t> sizes;
        for (const reports::Sample& sample : test.samples) sizes.push_back(sample.secondaries);
        EXPECT_EQ(fmt::format("rows: {}", fmt::join(sizes, ", ")), words) << row.text;
        continue;
      }
      const bool present = !words.starts_with("! ");
      EXPECT_EQ(said.find(present ? words : words.substr(2)) != said.npos, present)
          << row.text << ": " << said << "\n  " << words;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfClaims, Verdicts, ValuesIn(sections_of("verdicts.txt")),
                         name_of_section);

}  // namespace
}  // namespace assay::harness
