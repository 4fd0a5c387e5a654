#pragma once

// What a job of GitHub Actions is told besides the reports: annotations and the step's summary.

#include <string>

#include "harness/base/environment_variables.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Where GITHUB_ACTIONS is `true`: appends the record as Markdown to the file that
/// GITHUB_STEP_SUMMARY names, after what earlier steps' commands wrote there, as long as the whole
/// stays below reports::markdown_limit (cut with a word, above it GitHub drops all of it), and
/// returns the annotations to print. "" elsewhere. A summary that cannot be written is named in a
/// warning among the annotations: it is no reason to fail.
std::string tell_github(const reports::Record& record, const Environment& environment);

}  // namespace assay::harness
