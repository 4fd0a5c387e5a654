#pragma once

#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// A suite's estimators in groups that belong in one picture: those that one claim names together,
/// that the record compares, and mutants with their original. Each group is a suite with these
/// estimators and their comparisons, without tests; estimators keep their order, groups begin with
/// the first of theirs.
std::vector<Suite> groups(const Suite&);

}  // namespace assay::reports
