#pragma once

// The kill matrix as lines of a terminal. Not part of the public interface.

#include <string>
#include <vector>

#include "reports/words/kill_matrix.h"

namespace assay::reports {

/// A heading and a line for each mutant, none wider than `width` columns: names are shortened where
/// the numbers need the room, numbers never. Columns that do not fit stand in a second block, with
/// the mutants that have something there.
std::vector<std::string> kill_lines(const Suite& suite, const KillMatrix& matrix, int width);

}  // namespace assay::reports
