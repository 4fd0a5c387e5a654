// Claims about images, from YAML to verdict, record and maps.

#include <fmt/format.h>

#include "harness/command/commands.h"
#include "harness/record/record_of.h"
#include "reports/report_formats.h"
#include "tests/estimators/exr.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

constexpr const char* floor_16 = "luminaire/floor, width: 16, height: 16";

std::string floor_suite(const std::string& estimator, const std::string& test) {
  return fmt::format(
      "suite: s\nestimators:\n  a: {{plugin: {}}}\n  b: {{plugin: {}}}\ntests:\n  - {{{}}}\n",
      estimator, std::string(floor_16) + ", primaries: 32", test);
}

reports::Test floor_test(const std::string& estimator, const std::string& test,
                         const RunOptions& options = {}) {
  return run_test(floor_suite(estimator, test), options);
}

std::string mutant(const std::string& name) {
  return "mutants/floor_" + name + ", width: 16, height: 16, primaries: 64";
}

const reports::Map& map_named(const reports::Test& test, const std::string& name) {
  const auto found = std::find_if(test.maps.begin(), test.maps.end(),
                                  [&](const reports::Map& map) { return map.name == name; });
  if (found == test.maps.end()) throw std::out_of_range("no map " + name);
  return *found;
}

using ImageClaims = Placed;

// False alarm 0.01 at seed 1.
TEST_F(ImageClaims, AnImageThatIsRightPassesAndStatesWhatItExcluded) {
  const reports::Test test = floor_test(std::string(floor_16) + ", primaries: 32",
                                        "claim: mean(a) == analytic, detect: 2%");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(test.method, "image");
  ASSERT_EQ(test.channels.size(), 1u);
  EXPECT_EQ(test.channels[0].name, "16 x 16 irradiance");
  EXPECT_LT(*test.channels[0].effect.high, 0.02);
  EXPECT_TRUE(test.channels[0].effect.relative);
  ASSERT_TRUE(test.image);
  EXPECT_EQ(test.image->tested, 256u);
  EXPECT_GE(test.image->replicates, 16u);
  ASSERT_EQ(test.samples.size(), 1u);
}

// Each defect is found and located with probability above 0.99. A last column is seen by windows
// and by columns in turn.
TEST_F(ImageClaims, MutantsAreCaughtByTheSumThatFitsThem) {
  for (const auto& [name, statistic] :
       std::map<std::string, std::string>{{"tile", "window"},
                                          {"hot_pixels", "window"},
                                          {"last_column", ""},
                                          {"interlaced", "alternating"},
                                          {"global", "window"}}) {
    const reports::Test test =
        floor_test(mutant(name), "claim: mean(a) == analytic, secondaries: 256");
    expect_said(test, Verdict::fail);
    EXPECT_THAT(test.image->winner.statistic, HasSubstr(statistic)) << name;
  }
}

// The effect at the place in units of the picture, with an interval that leaves 0 out.
TEST_F(ImageClaims, TheTileIsLocated) {
  const reports::Test test =
      floor_test(mutant("tile"), "claim: mean(a) == mean(b), secondaries: 256");
  const reports::ImageFinding& winner = test.image->winner;
  EXPECT_EQ(winner.x, 8u);
  EXPECT_EQ(winner.y, 8u);
  EXPECT_EQ(winner.width, 4u);
  EXPECT_EQ(winner.height, 4u);
  EXPECT_EQ(winner.component, "irradiance");
  EXPECT_GT(*winner.z, 6);
  expect_said(test, Verdict::fail, {"x 8-11, y 8-11 (4 x 4 pixels)", "too bright ("});
  ASSERT_TRUE(winner.effect);
  EXPECT_GT(*winner.effect->low, 0);
  EXPECT_LT(*winner.effect->low, *winner.effect->estimate);
}

TEST_F(ImageClaims, MapsHoldZMeanVarianceAndReference) {
  const reports::Test test =
      floor_test(mutant("tile"), "claim: mean(a) == analytic, secondaries: 64, expect: fail");
  std::vector<std::string> names;
  for (const reports::Map& map : test.maps) {
    names.push_back(map.name);
    EXPECT_EQ(map.texels.values.size(), 256u);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"z", "mean", "variance", "reference"}));
  const auto& z = map_named(test, "z").texels.values;
  const auto& mean = map_named(test, "mean").texels.values;
  const auto& variance = map_named(test, "variance").texels.values;
  const auto& reference = map_named(test, "reference").texels.values;
  for (std::size_t i = 0; i < z.size(); ++i) {
    // The test's halves have weights of their own, so that its z is near Student's t.
    const double t = (mean[i] - reference[i]) / std::sqrt(variance[i] / 64.0);
    EXPECT_NEAR(z[i], t, 0.5 + 0.2 * std::abs(t)) << i;
  }
}

TEST_F(ImageClaims, AComponentOrAPixelCanBeNamed) {
  const std::string text =
      "suite: s\nestimators:\n  a: {plugin: analytic/ramp, colour: true, primaries: 16}\ntests:\n"
      "  - claim: mean(a.green) within 5% of analytic\n"
      "  - {claim: mean(a.x3y5.blue) == analytic, secondaries: 200}\n"
      "  - {claim: bias(a) == 0, secondaries: 32}\n";
  const reports::Record record = run_text(text);
  const std::vector<reports::Test>& tests = record.suites[0].tests;
  EXPECT_EQ(tests[0].image->components, std::vector<std::string>{"green"});
  EXPECT_EQ(tests[0].image->tested, 256u);
  EXPECT_EQ(tests[0].verdict, Verdict::pass) << tests[0].message;
  EXPECT_FALSE(tests[1].image);
  EXPECT_EQ(tests[1].samples[0].channel, "x3y5.blue");
  EXPECT_EQ(tests[2].image->tested, 768u);
  EXPECT_EQ(tests[2].verdict, Verdict::pass) << tests[2].message;
}

TEST_F(ImageClaims, MapsReadBackEqualToTheRecord) {
  const std::string suite = place.write(
      "s.yaml", floor_suite(mutant("tile"), "claim: mean(a) == mean(b), secondaries: 16"));
  reports::Record record = run_files({suite});
  write_maps(record, place.file("run.json"));
  const reports::Record saved = reports::read_json(reports::json(record), "run.json");
  const reports::Test& test = saved.suites[0].tests[0];
  EXPECT_EQ(test, record.suites[0].tests[0]);
  ASSERT_EQ(test.maps.size(), 5u);
  for (const reports::Map& map : test.maps) {
    EXPECT_EQ(map.file.find("run.maps/s_mean_a_mean_b"), 0u) << map.file;
    EXPECT_EQ(draws::read_exr_channel(place.file(map.file), map.name + ".irradiance"),
              map.texels.values)
        << map.name;
  }
  EXPECT_EQ(map_named(test, "other_mean").source, "b");
}

// Pixels are independent: the variance of their mean is the mean of theirs over their number. The
// quantile of nearly as many degrees of freedom as the image has numbers is the normal's.
TEST_F(ImageClaims, TheMeanOfAnImageHasAnIntervalInTheSuitesPicture) {
  const reports::Record record = run_text(floor_suite(
      std::string(floor_16) + ", primaries: 32", "claim: mean(a) == analytic, secondaries: 32"));
  const reports::EstimatorSummary& summary = record.suites[0].estimators[0];
  const reports::Estimate& mean = summary.channels[0].mean;
  ASSERT_TRUE(mean.low && mean.high);
  EXPECT_NEAR(*mean.low + *mean.high, 2 * *mean.value, 1e-12);
  const double per_pixel = *summary.channels[0].variance.value / 32;  // of one observation
  const double error = std::sqrt(per_pixel / (256.0 * static_cast<double>(summary.secondaries)));
  EXPECT_NEAR((*mean.high - *mean.low) / 2 / error, 2.576, 0.02);
  EXPECT_EQ(summary.variance_of, "primary");
}

}  // namespace
}  // namespace assay::harness
