#pragma once

// Pieces of the HTML page. Not part of the public interface.

#include <cstddef>
#include <string>

#include "reports/record.h"

namespace assay::reports {

/// The style sheet and the script (which only hides rows and opens what is printed).
extern const char* const page_style;
extern const char* const page_script;

/// Where a test stands in the record: its link target.
struct TestPlace {
  std::size_t suite = 0;
  std::size_t test = 0;
};
std::string anchor(TestPlace);

/// "passed", "failed", "inconclusive", "skipped": a style.
const char* outcome_style(Outcome);

/// Mark and verdict as a badge.
std::string badge(const Test&);

/// A figure with a caption; empty where the chart is.
std::string figure(const std::string& chart, const std::string& caption);

std::string suite_section(const Record&, std::size_t suite);
std::string test_section(const Test&, TestPlace);

}  // namespace assay::reports
