#pragma once

// Which method sees which defect: what a suite's tests say of its mutants, by mutant and method.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// What became of a mutant under one method.
enum class Fate {
  killed,    ///< the claim was refuted
  broken,    ///< an observation was not finite, which is seen as well
  survived,  ///< no evidence against the claim
  open       ///< undecided, or no valid test
};

/// The best that one method did against one mutant: of several tests the one that killed it with
/// the fewest samples, else the one that would have found the least effect, else the first.
struct KillCell {
  std::size_t test = 0;  ///< in the suite
  Fate fate = Fate::open;
  std::uint64_t samples = 0;  ///< primary estimates that were drawn of the mutant (a pixel)
};

struct KillRow {
  std::size_t mutant = 0;                      ///< in the suite's estimators
  std::vector<std::optional<KillCell>> cells;  ///< one a method; none: not tested by it
};

/// Rows and columns of a suite's mutants. The methods are named by the textbook test of a claim, in
/// the order t, Welch, chi-square, F, KS, goodness of fit, image pyramid, then other quantities by
/// their names; the test's own `method` says what the pilot put in its place.
struct KillMatrix {
  std::vector<std::string> methods;
  std::vector<KillRow> rows;
};

/// Of the mutants that were tested. An estimator is a mutant where the record names its original; a
/// claim on two mutants counts for the first. Skipped tests and those without a sample are left
/// out.
KillMatrix kill_matrix(const Suite&);

/// Whether there is something to compare: a mutant that was tested by two methods or more.
bool is_worth_showing(const KillMatrix&);

/// "6400", "1.05 M": samples at which a mutant was killed; "< 0.36 %": it survived, and an effect
/// of that size would have been found; "not finite", "undecided", "invalid".
std::string short_text(const Suite&, const KillCell&);

/// The same as a sentence, with the samples of a survivor too: "killed by 6400 samples", "survives
/// 65.5 k samples: an effect of 0.36 % or more would have been found".
std::string sentence(const Suite&, const KillCell&);

/// "112 of 112 mutants are killed by a method at least: t 90 of 105, …", plugins counted once.
std::string kill_totals(const Suite&, const KillMatrix&);

/// How to read the short texts.
extern const char* const kill_matrix_legend;

}  // namespace assay::reports
