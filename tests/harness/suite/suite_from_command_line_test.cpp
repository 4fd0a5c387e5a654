#include "harness/suite/suite.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

Suite suite_with(std::vector<EstimatorEntry> estimators) {
  Suite suite;
  suite.estimators = std::move(estimators);
  return suite;
}

std::vector<Suite> suites_with(const std::string& option) {
  return {suite_with({parse_estimator_option(option)})};
}

TEST(EstimatorOption, NamesPluginPrimariesAndParameters) {
  const EstimatorEntry entry = parse_estimator_option(
      "h=luminaire/hemisphere,primaries=1e2,scene={light: {polygon: [[0, 0, 1], [1, 0, 1]]}}");
  EXPECT_EQ(entry.name, "h");
  EXPECT_EQ(entry.plugin, "luminaire/hemisphere");
  EXPECT_EQ(entry.primaries, 100U);
  ASSERT_EQ(entry.parameters.members().size(), 1U);
  EXPECT_EQ(entry.parameters.find("scene")->find("light")->find("polygon")->items().size(), 2U);
}

TEST(SetParameter, ReplacesAndAdds) {
  std::vector<Suite> suites = suites_with("a=luminaire/area");
  set_parameter(suites, "a.scene=triangle");
  set_parameter(suites, "a.scene=rectangle,a.primaries=32");
  EXPECT_EQ(suites[0].estimators[0].parameters.find("scene")->text(), "rectangle");
  EXPECT_EQ(suites[0].estimators[0].primaries, 32U);
  set_parameter(suites, "a.primaries=auto");
  EXPECT_EQ(suites[0].estimators[0].primaries, std::nullopt);
}

TEST(SetParameter, ReachesEverySuiteThatHasTheEstimator) {
  std::vector<Suite> suites{suite_with({parse_estimator_option("a=luminaire/area")}),
                            suite_with({parse_estimator_option("b=luminaire/area")}),
                            suite_with({parse_estimator_option("a=luminaire/area")})};
  set_parameter(suites, "a.scene=rectangle");
  EXPECT_NE(suites[0].estimators[0].parameters.find("scene"), nullptr);
  EXPECT_EQ(suites[1].estimators[0].parameters.find("scene"), nullptr);
  EXPECT_NE(suites[2].estimators[0].parameters.find("scene"), nullptr);
}

TEST(SetParameter, KnowsTheScenesOfTheSuite) {
  std::vector<Suite> suites = suites_with("a=luminaire/area");
  suites[0].scenes = Value::map({{"lamp", Value::map({{"light", Value::scalar("x")}})}});
  set_parameter(suites, "a.scene=lamp");
  EXPECT_EQ(suites[0].estimators[0].parameters.find("scene")->kind(), Value::Kind::map);
}

TEST(SuiteOfClaim, TakesPluginsByTheirName) {
  const Suite suite = suite_of_claim(
      {.claim = " mean(luminaire/area) == mean(luminaire/cosine)",
       .primaries = 16,
       .keys = {
           {"detect", "0.5%"}, {"allow", "1e-5%"}, {"test", "welch"}, {"secondaries", "500"}}});
  ASSERT_EQ(suite.estimators.size(), 2U);
  EXPECT_EQ(suite.estimators[0].plugin, "luminaire/area");
  EXPECT_EQ(suite.estimators[1].primaries, 16U);
  const TestEntry& test = suite.tests.at(0);
  EXPECT_EQ(test.id, "check/mean(luminaire/area) == mean(luminaire/cosine)");
  EXPECT_EQ(test.detect->value, 0.005);
  EXPECT_EQ(test.allow->value, 1e-7);
  EXPECT_EQ(test.method, "welch");
  EXPECT_EQ(test.secondaries, 500U);
}

TEST(SuiteOfClaim, TakesNamedEstimators) {
  const Suite suite = suite_of_claim(
      {.claim = "variance(a) < variance(h)",
       .estimators = {"a=luminaire/area", "h=luminaire/hemisphere,scene=rectangle"}});
  ASSERT_EQ(suite.estimators.size(), 2U);
  EXPECT_EQ(suite.estimators[1].parameters.find("scene")->text(), "rectangle");
  const Suite shared =
      suite_of_claim({.claim = "mean(luminaire/area) == 2 * mean(luminaire/area)"});
  EXPECT_EQ(shared.estimators.size(), 1U);
}

}  // namespace
}  // namespace assay::harness
