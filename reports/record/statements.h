#pragma once

// What a run says of the statements of its suites. The answer follows from the verdicts alone.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

enum class Answer {
  yes,      ///< every test under `holds` has its expected verdict, and none stands under `fails`
  only_if,  ///< so have those under `holds` and those under `fails`
  no,       ///< so have those under `fails`, and none stands under `holds`
  open,     ///< of some test the verdict is inconclusive, invalid, error or skipped, or it is not
            ///< in the record
  contradicted  ///< some test passed that should fail, or failed that should pass
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

/// The tests of one of the statement's lists: first what is not as expected, then what is not
/// decided, then the rest in the order of the list.
std::vector<Witness> witnesses(const Suite&, const std::vector<std::string>& names);

/// How many statements a record has.
std::size_t statement_count(const Record&);

}  // namespace assay::reports
