#pragma once

// Statements and their answers in words, the same in every format.

#include <string>

#include "reports/record/record.h"
#include "reports/record/statements.h"

namespace assay::reports {

/// The answer with what needs a look marked: "yes", "no", "only if", "? open", "✗ contradicted".
std::string answer_text(Answer);

/// "only if the sky is peaked"; of an answer without a condition answer_text().
std::string whole_answer(const Suite&, const Statement&);

/// "31 statements: 14 yes, 12 only if, 5 no."
std::string statement_totals(const Record&);

/// How to read the answers.
extern const char* const statement_legend;

/// The finding of a test: "ratio of variances ×0.0717 [×0.07, ×0.0734] (99 % interval)". Without an
/// effect it is the p-value, without that the verdict; "not run" if the test is not in the record.
std::string finding(const Suite&, const Witness&);

/// The findings of one of a statement's lists in one line, the rest of more than two counted.
std::string findings(const Suite&, const std::vector<std::string>& names);

}  // namespace assay::reports
