#include "reports/words/describe.h"

#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Describe, OneIsSingular) {
  Cost cost;
  cost.samples = 1;
  EXPECT_EQ(cost_text(cost), "1\u00A0sample");
  cost.shadow_rays = 1;
  EXPECT_EQ(cost_text(cost), "1\u00A0ray");
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

TEST(Describe, ASideWhoseChannelHasAnotherNameIsCountedToo) {
  reports::Test test = passing();
  test.samples.push_back(sample("other"));
  test.samples[1].channel = "luminance";
  test.samples[1].secondaries = 100;
  EXPECT_THAT(plain_text(test), HasSubstr("; 100 of other with 64\u00A0primaries each\n"));
}

}  // namespace
}  // namespace assay::reports
