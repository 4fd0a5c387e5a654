#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// GitHub shows ten annotations of a kind for each step and drops the rest without a word.
inline constexpr std::size_t most_annotations = 10;

/// One workflow command a line (`::error file=…,line=…,title=…::message`) for what is not ok, the
/// worst first, and one (`::warning`) for what is undecided; of each kind at most ten, of which the
/// last counts the others. "" where all is well. Escaped as the runner's own toolkit does: in
/// messages per cent, carriage return and line feed; in file and title colon and comma too.
std::string annotations(const Record&);

}  // namespace assay::reports
