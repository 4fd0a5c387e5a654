#pragma once

// How often methods err: the result of `assay calibrate` as plain data, and its reports.

#include <cstdint>
#include <string>
#include <utility>
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
};

/// A method on a question about a law at one alpha.
struct CalibrationCell {
  std::string method;
  std::string question;  ///< "mean == number"
  std::string law;
  double alpha = 0;
  bool proof = false;  ///< the mistake is a pass

  /// The whole procedure on a true claim: pilot, choice of method, looks, gates. No runs where
  /// another method is the question's default.
  Rate mistaken;
  std::uint64_t inconclusive = 0;
  std::uint64_t invalid = 0;
  double observations = 0;  ///< mean over the runs, of each subject
  /// By which method the runs were judged, the most frequent first.
  std::vector<std::pair<std::string, std::uint64_t>> chosen = {};

  Rate found;   ///< of the false claim at `detect`: the right verdict
  Rate missed;  ///< the wrong one

  /// The method alone on the true claim: forced, one look, gates without effect.
  Rate alone;
  Rate red;          ///< a gate of it is red
  Rate alone_green;  ///< mistaken though no gate is red
  double alone_observations = 0;
};

struct Calibration {
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
