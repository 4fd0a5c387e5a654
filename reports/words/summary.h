#pragma once

// Verdicts, outcomes and what a run concluded, in the same words in every format.

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// ✓ ✗ ? – for ok, not ok, undecided and not run, in one column.
std::string mark(Outcome);

/// The verdict with what was expected of it, where that is not pass: "fail (as expected)",
/// "pass, but fail expected".
std::string verdict_text(const Test&);

/// How many tests had which outcome, as a sentence for a title.
std::string tally_sentence(const Tally&);

/// How many tests had which verdict, the urgent ones first: "1 pass, but fail expected; 57 pass; 20
/// fail (as expected)".
std::string verdict_counts(const Record&);

/// The error rates of a run's verdicts.
std::string error_rates(const Record&);

/// "False alarms: at most 4 runs in 100." of a total alpha; empty if that is 0.
std::string false_alarms(double alpha);

/// The same of all suites with tests.
std::string false_alarms(const Record&);

}  // namespace assay::reports
