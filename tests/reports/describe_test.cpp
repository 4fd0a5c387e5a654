#include "reports/words/describe.h"

#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

TEST(Describe, ParametersLoseTheQuotesOfTheirCanonicalForm) {
  EXPECT_EQ(parameters_text(R"(sampler=":all",scene="triangle")"), "sampler=all, scene=triangle");
  EXPECT_EQ(parameters_text(R"(scene={"light":{"polygon":[[1,2]]}},n=3)"),
            "scene={light:{polygon:[[1,2]]}}, n=3");
  EXPECT_EQ(parameters_text(""), "");
}

TEST(Describe, WhatWasNeverFiniteIsNone) {
  EXPECT_EQ(data_text(std::nullopt), "none");
  EXPECT_EQ(data_text(std::nan("")), "none");
  EXPECT_EQ(data_text(0.0), "0");
}

TEST(Describe, OneIsSingular) {
  Cost cost;
  cost.samples = 1;
  EXPECT_EQ(cost_text(cost), "1\u00A0sample");
  cost.shadow_rays = 1;
  EXPECT_EQ(cost_text(cost), "1\u00A0ray");
  EXPECT_EQ(cost_text({cost, Cost{.samples = 2}, Cost{.samples = 3}}),
            "1\u00A0ray and 5\u00A0samples without rays");
  EXPECT_EQ(cost_text({Cost{.samples = 2}}), "2\u00A0samples");
  EXPECT_EQ(cost_text(std::vector<Cost>{}), "");
  EXPECT_NE(plain_text(example_record().suites[0].tests[7]).find("with 1\u00A0primary each"),
            std::string::npos);
}

// A claim on two coordinates together has a channel of neither's name.
TEST(Describe, ObservationsOfSeveralChannelsAreCountedOnce) {
  reports::Test test = example_record().suites[0].tests[0];
  test.samples.push_back(test.samples[0]);
  test.samples[0].channel = "theta";
  test.samples[1].channel = "phi";
  test.channels[0].name = "theta, phi";
  EXPECT_NE(
      plain_text(test).find("observations: 16.4\u00A0k of area with 64\u00A0primaries each\n"),
      std::string::npos)
      << plain_text(test);
}

TEST(Describe, ObservationsOfAllSourcesTogetherCountEachSourceOnce) {
  reports::Test test = example_record().suites[0].tests[0];
  const reports::Sample sample = test.samples[0];
  const auto of = [&](const char* estimator, const char* channel) {
    reports::Sample other = sample;
    other.estimator = estimator;
    other.channel = channel;
    other.secondaries = 100;
    return other;
  };
  const auto counted = [&](const char* channel, const std::vector<reports::Sample>& samples) {
    test.channels[0].name = channel;
    test.samples = samples;
    return observations(test);
  };
  // Cells of two coordinates, of one source, of two, and of one against itself.
  EXPECT_EQ(counted("cell", {of("a", "theta"), of("a", "phi")}), 100u);
  EXPECT_EQ(counted("cell", {of("a", "theta"), of("b", "theta"), of("a", "phi"), of("b", "phi")}),
            200u);
  EXPECT_EQ(counted("cell", {of("a", "theta"), of("a", "theta"), of("a", "phi"), of("a", "phi")}),
            200u);
  EXPECT_EQ(counted("u", {of("a", "u"), of("b", "v")}), 200u);
  EXPECT_EQ(counted("u", {of("a", "u"), of("b", "u"), of("a", "v"), of("b", "v")}), 200u);
}

TEST(Describe, ASideWhoseChannelHasAnotherNameIsCountedToo) {
  reports::Test test = example_record().suites[0].tests[0];
  test.samples.push_back(test.samples[0]);
  test.samples[1].estimator = "other";
  test.samples[1].channel = "luminance";
  test.samples[1].secondaries = 100;
  EXPECT_NE(plain_text(test).find("; 100 of other with 64\u00A0primaries each\n"),
            std::string::npos)
      << plain_text(test);
}

TEST(Describe, AProofIsExplainedByItsContrary) {
  const std::string text = plain_text(example_record().suites[0].tests[1]);
  EXPECT_NE(text.find("contrary: variance(area) >= variance(hemisphere)\n"), std::string::npos);
  EXPECT_NE(text.find("evidence: p(contrary) = 2.3e-1205"), std::string::npos);
  EXPECT_EQ(text.find("null hypothesis"), std::string::npos);
  EXPECT_EQ(text.find("e-324"), std::string::npos);
}

}  // namespace
}  // namespace assay::reports
