#pragma once

// The answers that a run gives to the statements of its suites, in words. They follow from the
// verdicts alone.

#include <cstddef>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

enum class Answer {
  yes,          ///< All tests have their expected verdicts, and all are under `holds`.
  only_if,      ///< All have, under both `holds` and `fails`.
  no,           ///< All have, and all are under `fails`.
  open,         ///< Some test is inconclusive, invalid, an error, skipped or not in the record.
  contradicted  ///< Some test passed that should fail, or failed that should pass.
};

/// "yes", "only if", "no", "open", "contradicted".
const char* to_string(Answer);

Answer answer(const Suite&, const Statement&);

/// One a statement, by their words.
std::vector<std::string> answers(const Suite&);

/// How many statements a record has.
std::size_t statement_count(const Record&);

/// The answer with what needs a look marked: "yes", "no", "only if", "? open", "✗ contradicted".
std::string answer_text(Answer);

/// "only if the sky is peaked"; of an answer without a condition answer_text().
std::string whole_answer(const Suite&, const Statement&);

/// "31 statements: 14 yes, 12 only if, 5 no."
std::string statement_totals(const Record&);

/// The findings of one of a statement's lists in one line: "ratio of variances ×0.0717 (99 %
/// interval: ×0.07 to ×0.0734)". Without an effect it is the p-value, without that the verdict;
/// "not run" if the test is not in the record. Tests that are not as expected come first, then the
/// undecided ones, then the rest in the order of the list. The rest of more than two are counted.
std::string findings(const Suite&, const std::vector<std::string>& names);

}  // namespace assay::reports
