#include "harness/calibration/calibrate.h"

#include "tests/prelude.h"

namespace assay::harness {
namespace {

reports::Calibration measured(const CalibrateArguments& arguments) {
  return calibration(arguments, silence);
}

const reports::CalibrationCell& cell(const reports::Calibration& calibration,
                                     const std::string& question, const std::string& law) {
  for (const reports::CalibrationCell& each : calibration.cells) {
    if (each.question == question && each.law == law) return each;
  }
  throw std::out_of_range("no cell of " + question + " on " + law);
}

// Binomial(400, .05) lies outside 4 to 42 with probability 8e-6; of a power of .99 380 or fewer of
// 400 come with probability 1e-8.
TEST(Calibrate, TheTTestKeepsItsLevelAndFindsItsEffectOnNormalData) {
  const auto result =
      measured({.methods = {"t"}, .laws = {"normal"}, .alphas = {0.05}, .runs = 400, .threads = 1});
  const auto& t = cell(result, "mean == number", "normal(0, 1)");
  EXPECT_EQ(t.alone.runs(), 400U);
  EXPECT_GE(t.alone.fail.count, 4U);
  EXPECT_LE(t.alone.fail.count, 42U);
  EXPECT_LE(t.holds.fail.count, 42U);
  EXPECT_EQ(t.holds.invalid.count, 0U);
  EXPECT_EQ(t.alone.red.count, 0U);
  EXPECT_GT(t.off.fail.count, 380U);
  EXPECT_EQ(t.holds.by, (std::vector<reports::MethodRuns>{{"t", 400}}));
  EXPECT_EQ(reports::defects(result), 0U);
}

// F at nominal .01 rejects about a quarter of the pairs of exponential samples. Under a probability
// of .2, fewer than 20 of 300 have probability 1e-11.
TEST(Calibrate, FAloneIsFarOffOnExponentialDataAndItsGateIsRed) {
  const auto result = measured(
      {.methods = {"F"}, .laws = {"exponential"}, .alphas = {0.01}, .runs = 300, .threads = 1});
  const auto& f = cell(result, "variance == variance", "exponential(1)");
  EXPECT_GT(f.alone.fail.count, 20U);
  EXPECT_EQ(f.alone.red.count, 300U);
  EXPECT_EQ(f.alone_not_red.count, 0U);
  EXPECT_EQ(f.holds.by.at(0).method, "influence-t");
  // P(more than 14 of 300 at .01) = 8e-7.
  EXPECT_LE(f.mistaken().count, 14U);
  EXPECT_EQ(reports::defects(result), 0U);
}

// Theta of the claim that is off stands on the border of what `within` claims.
TEST(Calibrate, OfAProofAPassIsTheMistake) {
  const auto result = measured(
      {.methods = {"tost"}, .laws = {"uniform"}, .alphas = {0.05}, .runs = 200, .threads = 1});
  const auto& tost = cell(result, "mean within x of number", "uniform(0, 1)");
  EXPECT_TRUE(tost.proof);
  // P(more than 27 of 200 at .05) = 2e-6.
  EXPECT_LE(tost.mistaken().count, 27U);
  EXPECT_GT(tost.holds.pass.count, 150U);
}

TEST(Calibrate, FixedSamplesAreOneLookOfThatMany) {
  const auto result = measured({.methods = {"welch"},
                                .laws = {"normal(3, 2)"},
                                .alphas = {0.05},
                                .runs = 20,
                                .samples = 150,
                                .threads = 1});
  const auto& welch = cell(result, "mean == mean", "normal(3, 2)");
  EXPECT_EQ(welch.holds.observations, 150);
  EXPECT_EQ(welch.alone.observations, 150);
}

void expect_same(const reports::CalibrationCell& one, const reports::CalibrationCell& other) {
  EXPECT_EQ(one.holds.fail.count, other.holds.fail.count);
  EXPECT_EQ(one.alone.fail.count, other.alone.fail.count);
  EXPECT_EQ(one.holds.observations, other.holds.observations);
  EXPECT_EQ(one.holds.by, other.holds.by);
}

TEST(Calibrate, ThreadsChangeNoCount) {
  const CalibrateArguments one{
      .methods = {"t"}, .laws = {"exponential"}, .alphas = {0.05, 0.01}, .runs = 30, .threads = 1};
  CalibrateArguments three = one;
  three.threads = 3;
  const auto a = measured(one);
  const auto b = measured(three);
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (std::size_t i = 0; i < a.cells.size(); ++i) expect_same(a.cells[i], b.cells[i]);
}

// Chi-square and F treat flat data as normal, so they need as many observations as with normal
// data.
TEST(Calibrate, FlatDataAreGivenTheObservationsThatTheirTestNeeds) {
  const auto result = measured({.methods = {"chi-square", "F"},
                                .laws = {"uniform"},
                                .alphas = {0.001},
                                .runs = 100,
                                .threads = 1});
  ASSERT_EQ(result.cells.size(), 3U);
  // P(fewer than 90 of 100) is 6e-9 at .99, .96 at .83.
  for (const auto& each : result.cells) EXPECT_GE(each.off.fail.count, 90U) << each.question;
}

// They share what they draw.
TEST(Calibrate, AMethodCountsTheSameBesideOthers) {
  CalibrateArguments asked{.methods = {"chi-square", "F"},
                           .laws = {"exponential"},
                           .alphas = {0.05},
                           .runs = 30,
                           .threads = 1};
  const auto both = measured(asked);
  asked.methods = {"F"};
  const auto alone = measured(asked);
  ASSERT_EQ(alone.cells.size(), 1U);
  ASSERT_EQ(both.cells.size(), 3U);
  EXPECT_EQ(both.cells[2].method, "F");
  expect_same(both.cells[2], alone.cells[0]);
}

// Every question is asked once of each kind of law without an internal error.
TEST(Calibrate, EveryMethodHasCellsOnEveryLawThatSuitsIt) {
  const auto result = measured({.alphas = {0.05}, .runs = 1, .threads = 1});
  EXPECT_GT(result.cells.size(), 100U);
  const auto has = [&](const char* method, const std::string& law) {
    return std::any_of(result.cells.begin(), result.cells.end(),
                       [&](const auto& c) { return c.method == method && c.law == law; });
  };
  for (const std::string& law : calibration_laws()) {
    for (const char* method : {"t", "welch", "tost", "chi-square", "F", "influence-t",
                               "skewness-corrected-t", "slope", "ks", "image"}) {
      EXPECT_TRUE(has(method, law)) << method << " on " << law;
    }
  }
  EXPECT_TRUE(has("binomial", "bernoulli(0.01)"));
  EXPECT_FALSE(has("binomial", "normal(0, 1)"));
  EXPECT_TRUE(has("betting", "uniform(0, 1)"));
  EXPECT_TRUE(has("betting", "exponential(1)"));
  EXPECT_FALSE(has("betting", "normal(0, 1)"));
  EXPECT_TRUE(has("ks", "zero_inflated(0.1)"));
  EXPECT_TRUE(has("chi-square-two-sample", "normal(0, 1)"));
}

}  // namespace
}  // namespace assay::harness
