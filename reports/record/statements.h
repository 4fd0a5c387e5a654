#pragma once

// The answers that a run gives to the statements of its suites. They follow from the verdicts
// alone.

#include <cstddef>
#include <optional>
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

/// A test that a statement names: its place in the suite, if it was run.
struct Witness {
  std::string name;
  std::optional<std::size_t> test;
};

/// The tests of one of the statement's lists. Those that are not as expected come first, then the
/// undecided ones, then the rest in the order of the list.
std::vector<Witness> witnesses(const Suite&, const std::vector<std::string>& names);

/// How many statements a record has.
std::size_t statement_count(const Record&);

}  // namespace assay::reports
