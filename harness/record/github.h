#pragma once

// Reports a run to GitHub Actions: annotations and the step's summary.

#include <string>

#include "harness/base/environment_variables.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Returns the annotations to print; "" unless GITHUB_ACTIONS is `true`. It also appends the record
/// as Markdown to the file that GITHUB_STEP_SUMMARY names. GitHub drops a summary above
/// reports::markdown_limit, so the text is cut there, with a remark. A summary that cannot be
/// written becomes a warning among the annotations, not a failure.
std::string tell_github(const reports::Record& record, const Environment& environment);

}  // namespace assay::harness
