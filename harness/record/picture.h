#pragma once

#include "harness/record/comparisons.h"
#include "harness/record/record_of.h"

namespace assay::harness {

/// The suite's estimators side by side: mean and variance of each with intervals, and where each
/// pair of estimators of one quantity stands (`comparisons`); rows that may depend on each other
/// count as so many fewer (stats::allowance_for_dependence). Descriptive: outside the family.
void add_pictures(const SuiteRun& run, reports::Suite& suite);

/// What comparisons are made of.
Pictured pictured(const Picture& picture, const SuiteRun& run);
/// The names of the two estimators that a claim is about, else none.
std::vector<std::string> compared_by(const Question& question);

reports::Cost cost_of(const Summary& summary);

/// The pool's stream as the record names it: 16 hexadecimal digits.
std::string stream_text(const Pool& pool);

}  // namespace assay::harness
