#pragma once

// What the methods are calibrated on: for each law the claims about it that are true, those that
// are false by just `detect`, and each method on its own.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/sampling/prepare.h"
#include "harness/suite/suite.h"

namespace assay::harness {

/// The laws of a calibration unless others are named, as `analytic/law` reads them.
const std::vector<std::string>& calibration_laws();

/// The law a user names: the default one of that family, or any with its numbers. InputError with
/// the laws there are for one that `analytic/law` does not know.
std::string calibration_law(const std::string& named);

/// What `detect` is of each kind of question, in words.
std::string calibration_effects();

/// InputError with the methods there are for one that has no cases.
void require_calibrated(const std::string& method);

/// A method on a question about a law.
struct CalibrationCase {
  std::string method;
  std::string question;  ///< "mean == number"
  bool proof = false;    ///< a pass is the mistake
  /// Theta at the border of the claimed region; of a proof at that of the forbidden one. Missing
  /// where another method is the question's default.
  std::optional<TestEntry> true_claim = {};
  /// Theta at `detect`; of a proof 0. Missing where no law at that distance is at hand.
  std::optional<TestEntry> false_claim = {};
  /// The true claim by this method alone: forced, all observations in one look; its gates are shown
  /// and have no effect.
  std::optional<TestEntry> alone = {};
};

struct CalibrationScope {
  std::string law;
  std::vector<std::string> methods = {};  ///< these only; none: all
  /// Observations of every test, in one look. Else tests are planned by `detect`, in looks, and a
  /// method alone takes 1000, or 64 images.
  std::optional<std::uint64_t> samples = {};
};

/// The estimators that the cases of one law name, and the cases; none where no question suits the
/// method and the law. Questions point into it: it stays where it is.
struct CalibrationBench {
  std::string law;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<CalibrationCase> cases;

  explicit CalibrationBench(const CalibrationScope& scope);
  CalibrationBench(const CalibrationBench&) = delete;
  CalibrationBench& operator=(const CalibrationBench&) = delete;
};

}  // namespace assay::harness
