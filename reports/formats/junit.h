#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as JUnit XML, in the subset that GitLab, Jenkins, GitHub's actions and junitparser
/// share. A test is one case, with its own class name and name. A case that is not ok has exactly
/// one of three elements. <error> stands for the verdict error, <skipped> for inconclusive and
/// skipped, and <failure type="VERDICT"> for the rest. Numbers stand both as properties and as
/// text. The texts of a case stay below 64 KiB.
std::string junit(const Record&);

}  // namespace assay::reports
