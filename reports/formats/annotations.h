#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// GitHub shows ten annotations of a kind for each step and drops the rest without a word.
inline constexpr std::size_t most_annotations = 10;

/// GitHub's workflow commands, one a line: `::error file=…,line=…,title=…::message`. `::error`
/// names what is not ok, the worst first; `::warning` names what is undecided. Each kind has at
/// most ten, and the last counts the others. Returns "" if all is well. Escapes as the runner's
/// toolkit does: per cent, carriage return and line feed; in file and title colon and comma too.
std::string annotations(const Record&);

}  // namespace assay::reports
