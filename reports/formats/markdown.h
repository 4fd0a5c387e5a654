#pragma once

#include <cstddef>
#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// GitHub drops a whole step summary above 1024 KiB; other steps may have written to it before.
inline constexpr std::size_t markdown_limit = 900 * 1024;

/// The record as Markdown for a job summary ($GITHUB_STEP_SUMMARY, a merge request's comment): what
/// is not ok first, with message and replay command, then a table of tests for each suite. At most
/// `limit` bytes; what was left out is said at the end.
std::string markdown(const Record&, std::size_t limit = markdown_limit);

}  // namespace assay::reports
