#pragma once

// Verdicts, outcomes and what a run concluded, in the same words in every format.

#include <string>

#include "reports/record.h"

namespace assay::reports {

/// "ok", "not ok", "undecided", "not run".
std::string outcome_word(Outcome);

/// ✓ ✗ ? – : the same in one column.
std::string mark(Outcome);

/// The verdict with what was expected of it, where that is not pass: "fail (as expected)",
/// "pass, but fail expected".
std::string verdict_text(const Test&);

/// How many tests had which outcome, as a sentence for a title.
std::string tally_sentence(const Tally&);

/// How many tests had which verdict: "57 pass; 20 fail (as expected); 1 pass, but fail expected".
std::string verdict_counts(const Record&);

/// What the verdicts of a run may be relied on for: its error rates.
std::string error_rates(const Record&);

/// Where a test stands in lists that begin with what needs a look: not ok, undecided, not run, not
/// the plain pass that was expected, pass.
int urgency(const Test&);

}  // namespace assay::reports
