#include "reports/record/calibration.h"

#include "reports/words/text.h"
#include "tests/reports/approved.h"
#include "tests/reports/prelude.h"

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

/// A cell that is off while its gate is red, one above its level, one without a red gate, one of a
/// method that is no question's default, and one at another level.
Calibration calibration() {
  Calibration all{.seed = 7,
                  .runs = 1000,
                  .started = "2026-01-01T00:00:00Z",
                  .detect = "0.15 of <means>",
                  .cells = {cell("F"), cell("t"), cell("welch"), cell("influence-t"), cell("F")}};
  all.cells[1].holds.fail.low = 0.0126;
  all.cells[2].alone_not_red = rate(300, 0.2, 0.4);
  all.cells[3].holds = all.cells[3].off = {};
  all.cells[4].alpha = 0.001;
  all.cells[4].holds.fail.low = 1e-4;
  return all;
}

TEST(Calibration, ACellErrsWhereItsLowerLimitExceedsTheTolerance) {
  const Calibration all = calibration();
  for (std::size_t i = 0; i < all.cells.size(); ++i) {
    EXPECT_EQ(above(all, all.cells[i]), i == 1) << i;
    EXPECT_EQ(unflagged(all, all.cells[i]), i == 2) << i;
  }
  EXPECT_EQ(defects(all), 2U);
  EXPECT_EQ(verdict_sentence(all), "2 of 5 cells err too often");
  EXPECT_EQ(verdict_sentence({.cells = {cell("F")}}), "no cell of 1 is found to err too often");
}

TEST(Approved, CalibrationsAreAsApproved) {
  expect_approved("calibration.txt", console(calibration()));
  expect_approved("calibration.md", markdown(calibration()));
  expect_approved("calibration.json", json(calibration()));
  for (const std::string& line : lines(console(calibration()))) EXPECT_LE(columns(line), 100);
}

// A proof errs by passing what is off. All else errs by failing what holds.
TEST(Calibration, OfAProofThePassIsTheMistake) {
  CalibrationCell tost = cell("tost");
  tost.proof = true;
  EXPECT_EQ(tost.mistaken().count, 1U);
  EXPECT_EQ(tost.alone_mistaken().count, 700U);
  EXPECT_EQ(cell("F").mistaken().count, 9U);
}

}  // namespace
}  // namespace assay::reports
