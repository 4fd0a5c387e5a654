#include "reports/words/describe.h"

#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

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
}

// A claim on two coordinates together has a channel of neither's name.
TEST(Describe, ObservationsOfSeveralChannelsAreCountedOnce) {
  reports::Test test = passing();
  test.samples.push_back(test.samples[0]);
  test.samples[0].channel = "theta";
  test.samples[1].channel = "phi";
  test.channels[0].name = "theta, phi";
  EXPECT_THAT(plain_text(test),
              HasSubstr("observations: 16.4\u00A0k of area with 64\u00A0primaries each\n"));
}

TEST(Describe, ObservationsOfAllSourcesTogetherCountEachSourceOnce) {
  reports::Test test = passing();
  const auto of = [](const char* estimator, const char* channel) {
    reports::Sample other = sample(estimator);
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
  reports::Test test = passing();
  test.samples.push_back(sample("other"));
  test.samples[1].channel = "luminance";
  test.samples[1].secondaries = 100;
  EXPECT_THAT(plain_text(test), HasSubstr("; 100 of other with 64\u00A0primaries each\n"));
}

}  // namespace
}  // namespace assay::reports
