#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as JUnit XML, in the subset that GitLab, Jenkins, GitHub's actions and junitparser
/// share: one case a test with a class name and name of its own; exactly one <error> (verdict
/// error), <failure type="VERDICT"> (any other test that is not ok) or <skipped> (inconclusive,
/// skipped) where it is not ok; the numbers both as properties and as text; texts below 64 KiB a
/// case.
std::string junit(const Record&);

}  // namespace assay::reports
