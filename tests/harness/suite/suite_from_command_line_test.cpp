
#include "harness/suite/suite.h"
#include "tests/harness/refusal.h"
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

std::string refused(std::vector<Suite> suites, const std::string& assignment) {
  return refusal([&] { set_parameter(suites, assignment); });
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

TEST(EstimatorOption, SaysWhatIsWrong) {
  const auto refused_option = [](const std::string& text) {
    return refusal([&] { parse_estimator_option(text); });
  };
  EXPECT_EQ(refused_option("luminaire/area"),
            "the plugin needs a name, which the claim uses: `--estimator x=luminaire/area`");
  EXPECT_EQ(refused_option("2=luminaire/area"),
            "`2` cannot name an estimator: a letter, then letters, digits, `_`, `-` and `/`");
  EXPECT_EQ(refused_option("a=luminaire/areas"),
            "there is no plugin `luminaire/areas`; did you mean `luminaire/area`?");
  EXPECT_EQ(refused_option("a=luminaire/area,sceen=triangle"),
            "luminaire/area has no parameter `sceen`; did you mean `scene`?");
  EXPECT_EQ(refused_option("a=luminaire/area,triangle"),
            "`triangle` is not key=value; a value with commas stands in brackets or quotes");
  EXPECT_EQ(refused_option("a=luminaire/area,scene=triangle,scene=rectangle"),
            "`scene` is given twice");
  EXPECT_EQ(refused_option("a=luminaire/area,scene="), "a value is missing after the `=`");
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

TEST(SetParameter, SaysWhatIsWrong) {
  const std::vector<Suite> suites = suites_with("area=luminaire/area");
  constexpr const char* form =
      "expected estimator.key=value; a value with commas stands in brackets or quotes";
  EXPECT_EQ(refused(suites, "area"), form);
  EXPECT_EQ(refused(suites, "scene=triangle"), form);
  EXPECT_EQ(refused(suites, ".scene=triangle"), form);
  EXPECT_EQ(refused(suites, "area.scene=a,b"), form);
  EXPECT_EQ(refused(suites, "aera.scene=triangle"),
            "no suite has an estimator `aera`; did you mean `area`?");
  EXPECT_EQ(refused(suites, "area.sceen=triangle"),
            "luminaire/area has no parameter `sceen`; did you mean `scene`?");
  EXPECT_EQ(refused(suites, "area.primaries=0"),
            "`primaries` must be a whole number, 1 or more, but it is `0`");
}

TEST(SuiteOfClaim, TakesPluginsByTheirName) {
  const Suite suite = suite_of_claim({.claim = " mean(luminaire/area) == mean(luminaire/cosine)",
                                      .detect = "0.5%",
                                      .allow = "1e-5%",
                                      .method = "welch",
                                      .primaries = 16,
                                      .secondaries = 500});
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
}

TEST(SuiteOfClaim, NamesASharedSourceOnce) {
  const Suite suite = suite_of_claim({.claim = "mean(luminaire/area) == 2 * mean(luminaire/area)"});
  EXPECT_EQ(suite.estimators.size(), 1U);
}

TEST(SuiteOfClaim, SaysWhatIsWrong) {
  const auto refused_check = [](const CheckArguments& arguments) {
    return refusal([&] { suite_of_claim(arguments); });
  };
  EXPECT_EQ(refused_check({.claim = "mean(hemisphere) == analytic"}),
            "1:6: there is no plugin `hemisphere`; did you mean `luminaire/hemisphere`?");
  EXPECT_EQ(refused_check({.claim = "mean(lamb) == 1", .estimators = {"lamp=luminaire/area"}}),
            "1:6: no --estimator is named `lamb`; did you mean `lamp`?");
  EXPECT_EQ(
      refused_check({.claim = "mean(luminaire/area) == 1", .estimators = {"b=luminaire/area"}}),
      "`b` is used nowhere, only `luminaire/area`: write `b` in its place, or leave the option "
      "out");
  EXPECT_EQ(refused_check({.claim = "mean(b) == 1",
                           .estimators = {"b=luminaire/area", "b=luminaire/cosine"}}),
            "a second estimator named `b`");
  EXPECT_EQ(refused_check({.claim = "mean(luminaire/area) == 1", .method = "welsh"}),
            "`test` cannot be `welsh`; did you mean `welch`?");
  EXPECT_EQ(refused_check({.claim = "mean(luminaire/area) == 1", .detect = "1%", .allow = "2%"}),
            "`detect` (1%) must be above `allow` (2%)");
  EXPECT_EQ(refused_check({.claim = "slope(bias(luminaire/area)) == -1"}),
            "1:1: a slope needs `over`: `over: {primaries: [8, 16, 32]}`");
}

}  // namespace
}  // namespace assay::harness
