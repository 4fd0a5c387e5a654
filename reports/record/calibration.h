#pragma once

// How often methods err: the result of `assay calibrate` as plain data, and its reports.

#include <cstdint>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// A rate over runs with exact binomial limits, each at the calibration's error over its cells.
struct Rate {
  std::uint64_t count = 0;
  std::uint64_t runs = 0;
  double low = 0;
  double high = 1;

  double value() const {
    return runs == 0 ? 0 : static_cast<double>(count) / static_cast<double>(runs);
  }
  ASSAY_FIELDS(Rate, count, runs, low, high)
};

/// A method, and the number of runs that it judged.
struct MethodRuns {
  std::string method;
  std::uint64_t runs = 0;
  ASSAY_FIELDS(MethodRuns, method, runs)
};

/// The verdicts on one claim over the runs. The first four rates add up to 1.
struct VerdictRates {
  Rate pass;
  Rate fail;
  Rate inconclusive;
  Rate invalid;             ///< or error, or refused before sampling
  Rate red;                 ///< a gate is red
  double observations = 0;  ///< mean over the runs, of each subject
  /// The most frequent first.
  std::vector<MethodRuns> by = {};

  std::uint64_t runs() const { return pass.runs; }
  ASSAY_FIELDS(VerdictRates, pass, fail, inconclusive, invalid, red, observations, by)
};

/// A method on a question about a law at one alpha.
struct CalibrationCell {
  std::string method;
  std::string question;  ///< "mean == number"
  std::string law;
  double alpha = 0;
  bool proof = false;  ///< the mistake is a pass of the claim that is off

  /// The whole procedure: pilot, choice of method, looks, gates. No runs where another method is
  /// the question's default.
  VerdictRates holds;  ///< On the claim that holds exactly.
  VerdictRates off;    ///< On the claim that is off by `detect`. There may be no runs.
  /// The method alone on the claim where it can be mistaken: forced, one look, gates without
  /// effect.
  VerdictRates alone;
  Rate alone_not_red;  ///< mistaken though no gate is red

  const Rate& mistaken() const { return proof ? off.pass : holds.fail; }
  const Rate& alone_mistaken() const { return proof ? alone.pass : alone.fail; }
  ASSAY_FIELDS(CalibrationCell, method, question, law, alpha, proof, holds, off, alone,
               alone_not_red)
};

struct Calibration {
  std::string report = "calibration";
  Tool tool;
  Environment environment;
  std::uint64_t seed = 1;
  std::uint64_t runs = 0;
  std::string started;
  double seconds = 0;
  double tolerance = 1.25;  ///< Times alpha: the limit of a rate.
  double error = 0.001;     ///< Probability that any cell's limit is beyond the truth.
  std::string detect;       ///< The `detect` of each kind of question, in words.
  std::vector<CalibrationCell> cells = {};
  ASSAY_FIELDS(Calibration, report, tool, environment, seed, runs, started, seconds, tolerance,
               error, detect, cells)
};

/// True if the procedure errs too often for certain.
bool above(const Calibration&, const CalibrationCell&);
/// True if the method alone errs too often for certain, and no gate says so.
bool unflagged(const Calibration&, const CalibrationCell&);
/// Cells of which one or the other holds.
std::size_t defects(const Calibration&);

/// "no cell of 72 is found to err too often", or how many do.
std::string verdict_sentence(const Calibration&);

/// Tables of at most 100 columns.
std::string console(const Calibration&);
std::string markdown(const Calibration&);
std::string json(const Calibration&);
/// The viewer's page: the rates over alpha drawn with their limits, and the tables.
std::string html(const Calibration&);

}  // namespace assay::reports
