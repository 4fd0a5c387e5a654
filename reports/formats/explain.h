#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// Tells what happened to a test, in sentences for a reader without a course in statistics, and
/// what to do next, as lines to paste.
std::string explain(const Suite&, const Test&, int width);

}  // namespace assay::reports
