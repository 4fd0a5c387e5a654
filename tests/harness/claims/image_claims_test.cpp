// Claims about images, from YAML to verdict, record and maps.

#include <fmt/format.h>

#include "harness/command/commands.h"
#include "harness/record/image_record.h"
#include "harness/record/replay.h"
#include "reports/formats/json.h"
#include "reports/formats/read_json.h"
#include "tests/estimators/exr.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr const char* floor_16 = "luminaire/floor, width: 16, height: 16";

std::string floor_suite(const std::string& estimator, const std::string& test) {
  return fmt::format(
      "suite: s\nestimators:\n  a: {{plugin: {}}}\n  b: {{plugin: {}}}\ntests:\n  - {{{}}}\n",
      estimator, std::string(floor_16) + ", primaries: 32", test);
}

reports::Test floor_test(const std::string& estimator, const std::string& test,
                         const RunOptions& options = {}) {
  return run_text(floor_suite(estimator, test), options).suites[0].tests[0];
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

struct Defect {
  const char* name;
  const char* statistic;
};

// Each defect is found and located with probability above 0.99. A last column is seen by windows
// and by columns in turn.
TEST_F(ImageClaims, MutantsAreCaughtByTheSumThatFitsThem) {
  for (const Defect& defect :
       {Defect{"tile", "window"}, Defect{"hot_pixels", "window"}, Defect{"last_column", nullptr},
        Defect{"interlaced", "alternating"}, Defect{"global", "window"}}) {
    const reports::Test test = floor_test(
        mutant(defect.name), "claim: mean(a) == analytic, secondaries: 256, expect: fail");
    EXPECT_EQ(test.verdict, Verdict::fail) << defect.name << ": " << test.message;
    EXPECT_TRUE(test.ok);
    if (defect.statistic == nullptr) continue;
    EXPECT_EQ(test.image->winner.statistic, defect.statistic) << defect.name;
  }
}

TEST_F(ImageClaims, TheTileIsLocated) {
  const reports::Test test =
      floor_test(mutant("tile"), "claim: mean(a) == analytic, secondaries: 256, expect: fail");
  const reports::ImageFinding& winner = test.image->winner;
  EXPECT_EQ(winner.x, 8u);
  EXPECT_EQ(winner.y, 8u);
  EXPECT_EQ(winner.width, 4u);
  EXPECT_EQ(winner.height, 4u);
  EXPECT_EQ(winner.component, "irradiance");
  EXPECT_GT(*winner.z, 6);
  EXPECT_THAT(test.message, HasSubstr("columns 8-11, rows 8-11 (4 x 4 pixels)"));
}

TEST_F(ImageClaims, MapsHoldZMeanVarianceAdjustedPAndReference) {
  const reports::Test test =
      floor_test(mutant("tile"), "claim: mean(a) == analytic, secondaries: 64, expect: fail");
  std::vector<std::string> names;
  for (const reports::Map& map : test.maps) {
    names.push_back(map.name);
    EXPECT_EQ(map.texels.values.size(), 256u);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"z", "p_adjusted", "mean", "variance", "reference"}));
  const auto& z = map_named(test, "z").texels.values;
  const auto& p = map_named(test, "p_adjusted").texels.values;
  const auto& mean = map_named(test, "mean").texels.values;
  const auto& variance = map_named(test, "variance").texels.values;
  const auto& reference = map_named(test, "reference").texels.values;
  for (std::size_t i = 0; i < z.size(); ++i) {
    // The test's halves have weights of their own, so that its z is near Student's t.
    const double t = (mean[i] - reference[i]) / std::sqrt(variance[i] / 64.0);
    EXPECT_NEAR(z[i], t, 0.5 + 0.2 * std::abs(t)) << i;
    const double alone = std::erfc(std::abs(z[i]) / std::sqrt(2.0));
    EXPECT_NEAR(p[i], -std::expm1(256 * std::log1p(-alone)), 1e-5) << i;
  }
}

TEST_F(ImageClaims, ThreadsChangeNoBit) {
  const std::string text = floor_suite(std::string(floor_16) + ", shared: true, primaries: 32",
                                       "claim: mean(a) == mean(b), detect: 3%");
  const auto without_times = [](reports::Record record) {
    return reports::json(reports::without_times(std::move(record)));
  };
  const std::string file = place.write("suite.yaml", text);
  const std::string one = without_times(run_files({file}, {.threads = 1}));
  EXPECT_EQ(one, without_times(run_files({file}, {.threads = 3})));
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

TEST_F(ImageClaims, TooFewImagesAreInvalidAndSayWhatHelps) {
  const reports::Test test = floor_test(std::string(floor_16) + ", primaries: 32",
                                        "claim: mean(a) == analytic, secondaries: 15");
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_EQ(test.message.find("15 images are too few"), 0u) << test.message;
  EXPECT_THAT(test.message, HasSubstr("take 16 `secondaries` or more"));
  // 32 primaries of 16 x 16 pixels and 15 images.
  const reports::Test paid = floor_test(std::string(floor_16) + ", primaries: 32",
                                        "claim: mean(a) == analytic, budget: 122880");
  EXPECT_EQ(paid.message.find("15 images are too few"), 0u) << paid.message;
  EXPECT_THAT(paid.message, HasSubstr("give a larger `budget`"));
}

TEST_F(ImageClaims, MapsReadBackEqualToTheRecord) {
  const std::string suite = place.write(
      "s.yaml", floor_suite(mutant("tile"), "claim: mean(a) == mean(b), secondaries: 16"));
  reports::Record record = run_files({suite});
  write_maps(record, place.file("run.json"));
  const reports::Record saved = reports::read_json(reports::json(record), "run.json");
  const reports::Test& test = saved.suites[0].tests[0];
  EXPECT_EQ(test, record.suites[0].tests[0]);
  ASSERT_EQ(test.maps.size(), 6u);
  for (const reports::Map& map : test.maps) {
    EXPECT_EQ(map.file.find("run.maps/s_mean_a_mean_b"), 0u) << map.file;
    EXPECT_EQ(draws::read_exr_channel(place.file(map.file), map.name + ".irradiance"),
              map.texels.values)
        << map.name;
  }
  EXPECT_EQ(map_named(test, "other_mean").source, "b");
}

TEST_F(ImageClaims, TheRecordedMethodIsDrawnAgainToTheBit) {
  const std::string suite =
      place.write("s.yaml", floor_suite(std::string(floor_16) + ", shared: true, primaries: 8",
                                        "claim: mean(a) == mean(b), detect: 5%"));
  const std::string json = place.write("run.json", reports::json(run_files({suite})));
  const Said said =
      said_by([&] { return replay({.record = json, .test = "s/mean(a) == mean(b)"}); });
  EXPECT_EQ(said.code, 0) << said.text;
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

// Against a constant that is wrong nearly everywhere, and against another image at twice the scale.
TEST_F(ImageClaims, ConstantsAndFactorsAreMetPixelByPixel) {
  const std::string text =
      "suite: s\nestimators:\n  a: {plugin: analytic/ramp, primaries: 16}\ntests:\n"
      "  - {claim: mean(a) == 5, secondaries: 32, expect: fail}\n"
      "  - {claim: mean(a) == 2 * mean(a), secondaries: 32, expect: fail}\n"
      "  - {claim: mean(a) == mean(a), secondaries: 32}\n";
  const reports::Record record = run_text(text);
  for (const reports::Test& test : record.suites[0].tests) EXPECT_TRUE(test.ok) << test.message;
  EXPECT_NEAR(*record.suites[0].tests[1].channels[0].effect.estimate, 0.5, 0.01);
}

reports::Test chains_test(const std::string& plugin) {
  const std::string text = fmt::format(
      "suite: s\nestimators:\n  a: {{plugin: {}, pixels: 4, primaries: 100}}\n"
      "tests:\n  - {{claim: mean(a) == analytic, secondaries: 100}}\n",
      plugin);
  return run_text(text).suites[0].tests[0];
}

// False alarm 0.01 at seed 1.
TEST_F(ImageClaims, DependentPixelsOfChainsAreJudgedByTheirCells) {
  EXPECT_EQ(chains_test("metropolis/mean_value").verdict, Verdict::pass);
  const reports::Test broken = chains_test("mutants/metropolis_inverted_ratio");
  EXPECT_EQ(broken.verdict, Verdict::fail) << broken.message;
  EXPECT_LT(*broken.image->winner.log10_p_adjusted, -6);
}

// The effect at the place in units of the picture, with an interval that leaves 0 out.
TEST_F(ImageClaims, AFailureSaysHowMuchTooBrightWhichPlaceIs) {
  const reports::Test test =
      floor_test(mutant("tile"), "claim: mean(a) == mean(b), secondaries: 64");
  ASSERT_EQ(test.verdict, Verdict::fail) << test.message;
  ASSERT_TRUE(test.image->winner.effect);
  EXPECT_GT(*test.image->winner.effect->low, 0);
  EXPECT_LT(*test.image->winner.effect->low, *test.image->winner.effect->estimate);
  EXPECT_THAT(test.message, HasSubstr("too bright ("));
}

}  // namespace
}  // namespace assay::harness
