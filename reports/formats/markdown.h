#pragma once

#include <cstddef>
#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// GitHub drops a whole step summary above 1024 KiB; other steps may have written to it before.
inline constexpr std::size_t markdown_limit = 900 * 1024;

/// The record as Markdown for a job summary ($GITHUB_STEP_SUMMARY) or a merge request's comment.
/// Tests that are not ok come first, with message and replay command; then each suite has a table.
/// The text has at most `limit` bytes and ends by saying what was cut.
std::string markdown(const Record&, std::size_t limit = markdown_limit);

}  // namespace assay::reports
