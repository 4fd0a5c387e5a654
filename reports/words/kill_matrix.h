#pragma once

// Which method sees which defect: what a suite's tests say of its mutants, by mutant and method.

#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// The best result of one method against one mutant. A kill by the fewest samples comes first. An
/// observation that was not finite comes next, then the survival with the least detectable effect,
/// then the first test. Samples are the primary estimates drawn of the mutant (a pixel).
struct KillCell {
  std::string test;  ///< id
  /// "6400" or "1.05 M" samples killed a mutant. "< 0.36 %": it survived, and an effect of that
  /// size would have been found. Else "not finite", "undecided" or "invalid".
  std::string text;
  /// The same as a sentence: "killed by 6400 samples". A survivor's samples are said too: "survives
  /// 65.5 k samples: an effect of 0.36 % or more would have been found".
  std::string sentence;
  bool killed = false;
  ASSAY_FIELDS(KillCell, test, text, sentence, killed)
};

struct KillRow {
  std::string mutant;
  std::string defect;
  std::vector<std::optional<KillCell>> cells;  ///< one a method; none: not tested by it
  ASSAY_FIELDS(KillRow, mutant, defect, cells)
};

/// Rows are mutants and columns are methods of a suite. A method has the name of the claim's
/// textbook test, in the order t, Welch, chi-square, F, KS, goodness of fit, image pyramid. Other
/// quantities follow by their names. The test's own `method` says what the pilot chose instead.
struct KillMatrix {
  std::vector<std::string> methods;
  std::vector<KillRow> rows;
  std::string totals;  ///< "112 of 112 mutants are killed. …: t 90 of 105, …", plugins counted once
  std::string legend;  ///< How to read the short texts.
  ASSAY_FIELDS(KillMatrix, methods, rows, totals, legend)
};

/// The matrix of the tested mutants. An estimator is a mutant if the record names its original. A
/// claim on two mutants counts for the first. Skipped tests and tests without a sample are left
/// out.
KillMatrix kill_matrix(const Suite&);

/// True if two methods or more tested some mutant.
bool is_worth_showing(const KillMatrix&);

}  // namespace assay::reports
