#include "harness/suite/suite.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

namespace fs = std::filesystem;

const fs::path test_suites = fs::path(ASSAY_SOURCE_DIR) / "tests/suites";

constexpr const char* small = R"(suite: small
estimators:
  darts: {plugin: analytic/dart_throwing}
tests:
  - claim: mean(darts) == analytic
)";

TEST(Suite, ReadsEveryKeyItDocuments) {
  const Suite suite = load_suite((test_suites / "every_key.yaml").string());
  EXPECT_EQ(suite.name, "every key");
  EXPECT_EQ(suite.about, "Two lines\nof text.\n");
  EXPECT_EQ(suite.stem, "every_key");
  EXPECT_EQ(suite.folder, test_suites.string());
  EXPECT_EQ(suite.alpha, 0.02);
  EXPECT_EQ(suite.beta, 0.03);
  EXPECT_EQ(suite.seed, 1000U);
  ASSERT_EQ(suite.estimators.size(), 2U);
  EXPECT_EQ(suite.estimators[0].name, "area");
  EXPECT_EQ(suite.estimators[0].plugin, "luminaire/area");
  EXPECT_EQ(suite.estimators[0].primaries, 100U);
  ASSERT_NE(suite.estimators[0].parameters.find("scene"), nullptr);
  EXPECT_NE(suite.estimators[0].parameters.find("scene")->find("light"), nullptr);
  EXPECT_EQ(suite.estimators[0].parameters.members().size(), 1U);
  EXPECT_EQ(suite.estimators[1].parameters.find("scene")->text(), "triangle");
  EXPECT_EQ(suite.estimators[1].primaries, std::nullopt);
  ASSERT_EQ(suite.tests.size(), 3U);
  const TestEntry& first = suite.tests[0];
  EXPECT_EQ(first.id, "every_key/all of it");
  EXPECT_EQ(to_string(*first.detect), "0.5%");
  EXPECT_EQ(first.allow->value, 1e-5);
  EXPECT_EQ(first.weight, 2.5);
  EXPECT_EQ(first.method, "welch");
  EXPECT_EQ(first.secondaries, 10000U);
  EXPECT_EQ(first.budget->primaries, 10000000U);
  EXPECT_EQ(first.budget->seconds, 2.5);
  EXPECT_EQ(first.expect, reports::Verdict::fail);
  EXPECT_EQ(first.tags, (std::vector<std::string>{"slow", "lamp"}));
  EXPECT_EQ(first.where.line, 15);
  const TestEntry& second = suite.tests[1];
  EXPECT_EQ(second.name, "slope(bias(area)) within 0.1 of -1");
  EXPECT_EQ(second.over->parameter, "primaries");
  EXPECT_EQ(second.over->values.size(), 3U);
  EXPECT_EQ(to_string(*second.reference), "hemi-2/x.irradiance");
  EXPECT_EQ(second.budget->seconds, 30);
  EXPECT_EQ(suite.tests[2].cost, CostKind::seconds);
  EXPECT_EQ(suite.tests[2].budget->primaries, 1000000U);
}

TEST(Suite, HasTheDocumentedDefaults) {
  const Folder folder;
  const Suite suite = load_suite(folder.write("small.yaml", small));
  EXPECT_EQ(suite.alpha, 0.01);
  EXPECT_EQ(suite.beta, 0.01);
  EXPECT_EQ(suite.seed, std::nullopt);
  const TestEntry& test = suite.tests.at(0);
  EXPECT_EQ(test.name, "mean(darts) == analytic");
  EXPECT_EQ(test.id, "small/mean(darts) == analytic");
  EXPECT_EQ(test.weight, 1);
  EXPECT_EQ(test.expect, reports::Verdict::pass);
  EXPECT_EQ(test.cost, CostKind::rays);
  EXPECT_FALSE(test.detect || test.allow || test.method || test.secondaries || test.budget ||
               test.over || test.reference);
}

TEST(Suite, ReadsJsonAsWell) {
  const Folder folder;
  const Suite suite = load_suite(folder.write("s.json", R"({"suite": "json", "alpha": 0.05,
  "estimators": {"darts": {"plugin": "analytic/dart_throwing"}},
  "tests": [{"claim": "mean(darts) == analytic", "detect": "0.5%"}]})"));
  EXPECT_EQ(suite.alpha, 0.05);
  EXPECT_EQ(suite.tests.at(0).claim.text, "mean(darts) == analytic");
}

TEST(Suite, TakesAClaimFoldedOverLines) {
  const Folder folder;
  const Suite suite = load_suite(
      folder.write("s.yaml", std::string(small) + "  - claim: >\n      mean(darts)\n      <= 4\n"));
  EXPECT_EQ(suite.tests.at(1).name, "mean(darts) <= 4");
}

TEST(Suite, RefusesWhatIsNotAFile) {
  EXPECT_EQ(refusal([] { load_suite("/nowhere/at/all.yaml"); }),
            "cannot read `/nowhere/at/all.yaml`: there is no such file");
  const Folder folder;
  EXPECT_EQ(refusal([&] { load_suite(folder.path().string()); }),
            "cannot read `" + folder.path().string() + "`: it is a folder; name the files in it");
  EXPECT_EQ(refusal([&] { load_suite(folder.write("raw.yaml", "suite: \xff\xfe\n")); }),
            "1:8: the byte 0xff is not UTF-8; save the file as UTF-8 text");
}

TEST(Suite, LoadsWithoutANameOfItsFolder) {
  const Folder folder;
  const fs::path before = fs::current_path();
  folder.write("small.yaml", small);
  fs::current_path(folder.path());
  const Suite suite = load_suite("small.yaml");
  fs::current_path(before);
  EXPECT_EQ(suite.folder, ".");
}

// Such paths have no canonical form, like those of a folder that may not be read.
TEST(Suite, AReportReplacesNothingOfAnotherName) {
  const std::string folder(300, 'x');
  refuse_overwriting(folder + "/run.html", {folder + "/run.yaml"});
  EXPECT_THAT(refusal([&] { refuse_overwriting(folder + "/a", {folder + "/./a"}); }),
              testing::HasSubstr("which a report would replace"));
}

// Each bad file breaks one rule; its first line is `# expect: ` and the refusal.
TEST(Suite, ThatIsWrongIsRefusedWhereItIs) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(test_suites)) {
    if (!entry.path().filename().string().starts_with("bad_")) continue;
    ++count;
    std::ifstream in(entry.path());
    std::string expected;
    std::getline(in, expected);
    EXPECT_EQ("# expect: " + refusal([&] { load_suite(entry.path().string()); }), expected)
        << entry.path();
  }
  EXPECT_GT(count, 100);
}

}  // namespace
}  // namespace assay::harness
