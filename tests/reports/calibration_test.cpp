#include "reports/record/calibration.h"

#include <nlohmann/json.hpp>

#include "reports/words/columns.h"
#include "tests/prelude.h"

namespace assay::reports {
namespace {

Rate rate(std::uint64_t count, double low, double high) {
  return {.count = count, .runs = 1000, .low = low, .high = high};
}

CalibrationCell cell(const std::string& method) {
  return {.method = method,
          .question = "variance == <number>",
          .law = "zero_inflated(0.1)",
          .alpha = 0.01,
          .holds = {.pass = rate(968, 0.95, 0.98),
                    .fail = rate(9, 0.002, 0.02),
                    .inconclusive = rate(3, 0, 0.01),
                    .invalid = rate(20, 0.01, 0.04),
                    .red = rate(20, 0.01, 0.04),
                    .observations = 1048576,
                    .by = {{"skewness-corrected-t", 900}, {"t", 100}}},
          .off = {.pass = rate(1, 0, 0.01),
                  .fail = rate(979, 0.96, 0.99),
                  .invalid = rate(20, 0.01, 0.04),
                  .observations = 2000,
                  .by = {{"t", 1000}}},
          .alone = {.pass = rate(700, 0.6, 0.8),
                    .fail = rate(300, 0.2, 0.4),
                    .red = rate(1000, 0.99, 1),
                    .observations = 1000,
                    .by = {{"F", 1000}}},
          .alone_not_red = rate(0, 0, 0.01)};
}

Calibration calibration(const std::vector<CalibrationCell>& cells) {
  return {.seed = 7,
          .runs = 1000,
          .started = "2026-01-01T00:00:00Z",
          .detect = "0.15 of <means>",
          .cells = cells};
}

TEST(Calibration, ACellErrsWhereItsLowerLimitExceedsTheTolerance) {
  CalibrationCell good = cell("F");
  CalibrationCell bad = cell("t");
  bad.holds.fail.low = 0.0126;
  CalibrationCell silent = cell("welch");
  silent.alone_not_red = rate(300, 0.2, 0.4);
  const Calibration all = calibration({good, bad, silent});
  EXPECT_FALSE(above(all, good));
  EXPECT_FALSE(unflagged(all, good)) << "off, and its gate is red";
  EXPECT_TRUE(above(all, bad));
  EXPECT_TRUE(unflagged(all, silent));
  EXPECT_EQ(defects(all), 2U);
  EXPECT_EQ(verdict_sentence(all), "2 of 3 cells err too often");
  EXPECT_THAT(console(all), HasSubstr("\n!! zero_inflated(0.1)"));
  EXPECT_THAT(console(all), HasSubstr("\n!  zero_inflated(0.1)"));
}

TEST(Calibration, TablesFitAHundredColumns) {
  CalibrationCell alone = cell("influence-t");
  alone.holds = alone.off = {};
  CalibrationCell strict = cell("F");
  strict.alpha = 0.001;
  strict.holds.fail.low = 1e-4;
  const std::string text = console(calibration({cell("chi-square"), alone, strict}));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 100) << line;
  EXPECT_THAT(text, HasSubstr("alpha 0.01: 1000 runs a cell"));
  EXPECT_THAT(text, HasSubstr("alpha 0.001"));
  EXPECT_THAT(text, HasSubstr("1.05\u00a0M"));
  EXPECT_THAT(text, HasSubstr("skewness-corrected-t"));
  EXPECT_THAT(text, HasSubstr("no cell of 3 is found to err too often"));
}

TEST(Calibration, JsonHoldsEveryCount) {
  const auto root = nlohmann::json::parse(json(calibration({cell("F")})));
  EXPECT_EQ(root["report"], "calibration");
  EXPECT_EQ(root["seed"], 7);
  const auto& first = root["cells"][0];
  EXPECT_EQ(first["holds"]["fail"]["count"], 9);
  EXPECT_EQ(first["holds"]["inconclusive"]["count"], 3);
  EXPECT_EQ(first["holds"]["by"][0]["method"], "skewness-corrected-t");
  EXPECT_EQ(first["holds"]["observations"], 1048576);
  EXPECT_EQ(first["off"]["fail"]["count"], 979);
  EXPECT_EQ(first["alone"]["red"]["runs"], 1000);
}

// A proof errs by passing what is off. All else errs by failing what holds.
TEST(Calibration, OfAProofThePassIsTheMistake) {
  CalibrationCell tost = cell("tost");
  tost.proof = true;
  EXPECT_EQ(tost.mistaken().count, 1U);
  EXPECT_EQ(tost.alone_mistaken().count, 700U);
  EXPECT_EQ(cell("F").mistaken().count, 9U);
}

TEST(Calibration, MarkdownHasARowAClaim) {
  const std::string text = markdown(calibration({cell("F"), cell("t")}));
  EXPECT_THAT(text, HasSubstr("|    F | "));
  EXPECT_THAT(text, HasSubstr("| holds | 0.968 | 0.009 | 0.003 | 0.02 | 0.002 | 0.02 | "));
  EXPECT_THAT(text, HasSubstr("| off | 0.001 | 0.979 | 0 | 0.02 |  |  | "));
  EXPECT_THAT(text, HasSubstr("|    t | "));
  EXPECT_THAT(text, Not(HasSubstr("<number>")));
}

TEST(Calibration, EveryFormatSaysWhatDetectIs) {
  const Calibration measured = calibration({cell("F")});
  EXPECT_THAT(console(measured), HasSubstr("detect    0.15 of <means>\n"));
  EXPECT_THAT(markdown(measured), HasSubstr("detect    0.15 of <means>\n"));
  EXPECT_EQ(nlohmann::json::parse(json(measured))["detect"], "0.15 of <means>");
}

}  // namespace
}  // namespace assay::reports
