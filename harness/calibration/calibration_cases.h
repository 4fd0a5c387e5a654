#pragma once

// Cases for calibration. For each law they hold claims that hold exactly, claims that are off by
// `detect`, and each method alone.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/sampling/prepare.h"
#include "harness/suite/suite.h"

namespace assay::harness {

/// The default laws, as `analytic/law` reads them.
const std::vector<std::string>& calibration_laws();

/// The law that a user names: a family's default, or any with its numbers. InputError with the
/// known laws if `analytic/law` does not know it.
std::string calibration_law(const std::string& named);

/// The `detect` of each kind of question, in words.
std::string calibration_effects();

/// InputError with the known methods if this one has no cases.
void require_calibrated(const std::string& method);

/// A method on a question about a law.
struct CalibrationCase {
  std::string method;
  std::string question;  ///< "mean == number"
  bool proof = false;    ///< True if a pass is the mistake.
  /// Theta is 0. Missing if another method is the question's default.
  std::optional<TestEntry> holds = {};
  /// Theta is at `detect`, for a proof at the border of the forbidden region. Missing if another
  /// method is the question's default, or no law at that distance is available.
  std::optional<TestEntry> off = {};
  /// The claim on which a verdict against the level is possible, with this method forced and all
  /// observations in one look. Gates are shown but have no effect.
  std::optional<TestEntry> alone = {};
};

struct CalibrationScope {
  std::string law;
  std::vector<std::string> methods = {};  ///< None: all.
  /// Observations of every test, in one look. Without it tests are planned by `detect`, in looks,
  /// and a method alone takes 1000, or 64 images.
  std::optional<std::uint64_t> samples = {};
};

/// The cases of one law with their estimators; empty if no question suits the method and the law.
/// Questions point into it, so it cannot move.
struct CalibrationBench {
  std::string law;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<CalibrationCase> cases;

  explicit CalibrationBench(const CalibrationScope& scope);
  CalibrationBench(const CalibrationBench&) = delete;
  CalibrationBench& operator=(const CalibrationBench&) = delete;
};

}  // namespace assay::harness
