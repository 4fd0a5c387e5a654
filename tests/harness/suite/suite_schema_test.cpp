// The editors' schema and the manual offer what this version takes, no more and no less.

#include "harness/base/text_file.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"
#include "harness/theta/ask.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

const std::string shipped_suites = std::string(ASSAY_SOURCE_DIR) + "/suites/";

/// The schema of a test's key. JSON is YAML.
Value schema_of(const std::string& key) {
  const std::string file = shipped_suites + "suite.schema.json";
  static const Document schema(file, read_text_file(file));
  return *schema.root().find("definitions")->find("test")->find("properties")->find(key);
}

std::vector<std::string> matches_of(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) {
    found.push_back((*at)[1]);
  }
  return found;
}

std::string manual_line(const std::string& beginning) {
  const std::string text = read_text_file(shipped_suites + "README.md");
  for (const std::string_view line : lines_of(text)) {
    if (line.starts_with(beginning)) return std::string(line);
  }
  return "";
}

bool is_tested(const QuantityRow& row) {
  const std::string number = row.of_a_probability ? ", 0.5" : "";
  const char* side = row.of_a_law ? "normal(0, 1)" : "1";
  const char* source = row.of_a_sampler ? "analytic/exponential_importance" : "analytic/normal";
  const Suite suite = suite_of_claim({.claim = row.word + "(" + source + number + ") == " + side});
  const auto estimators = prepare_all(suite);
  return refusal([&] { ask(suite.tests[0], estimators, 1); }) == "(nothing was refused)";
}

TEST(SuiteSchema, OffersTheQuantitiesThatAreTested) {
  std::vector<std::string> tested;
  for (const QuantityRow& row : quantities()) {
    if (is_tested(row)) tested.push_back(row.word);
  }
  std::vector<std::string> offered;
  for (const QuantityRow& row : quantities()) offered.push_back(row.word);
  EXPECT_THAT(tested, ElementsAreArray(offered));
  const std::string pattern = schema_of("claim").find("pattern")->text();
  offered.insert(offered.begin(), "slope");
  EXPECT_THAT(matches_of(pattern, "([a-z_]{2,})"), ElementsAreArray(offered)) << pattern;
}

TEST(SuitesReadme, OffersWhatTheSchemaOffers) {
  std::vector<std::string> offered;
  for (const QuantityRow& row : quantities()) offered.push_back(row.word);
  EXPECT_THAT(matches_of(manual_line("name     = "), "([a-z_]{2,})(?: \\||$)"),
              ElementsAreArray(offered));
}

}  // namespace
}  // namespace assay::harness
