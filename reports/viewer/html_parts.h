#pragma once

// Pieces of the HTML page. Not part of the public interface.

#include <cstddef>
#include <string>
#include <vector>

#include "reports/record/record.h"
#include "reports/viewer/colour_scale.h"
#include "reports/viewer/html_table.h"

namespace assay::reports {

/// The style sheet and the script (which only hides rows and opens what is printed).
extern const char* const page_style;
extern const char* const page_script;

/// Everything up to the body.
std::string page_head(const std::string& title);

/// The place of a test in the record, for its link target.
struct TestPlace {
  std::size_t suite = 0;
  std::size_t test = 0;
};
std::string anchor(TestPlace);

/// "passed", "failed", "inconclusive", "skipped": a style.
const char* outcome_style(Outcome);

/// Mark and verdict as a badge.
std::string badge(const Test&);

/// A figure with a caption, if there is one; empty where the chart is.
std::string figure(const std::string& chart, const std::string& caption);

/// A source's name, with its plugin and parameters below.
std::string source_markup(const std::string& name, const std::string& plugin,
                          const std::string& parameters);

/// A cost: rays or samples, with the CPU time below. Hovering shows all digits.
HtmlTable::Cell cost_cell(const Cost&);

/// The tests of a suite in the order of their urgency (reports/verdict.h).
std::vector<std::size_t> by_urgency(const Suite&);

/// The answers to the suites' statements in one table; empty if there are none.
std::string statements_section(const Record&);

/// All tests in one table: first what is not ok, then what is undecided, then the suites.
std::string overview(const Record&);

/// The estimators of a suite as bars, in numbers, and in pairs.
std::string estimator_pictures(const Suite&);

/// Which method sees which defect, as a picture and in words; empty where a suite has no mutant
/// that was tested by two methods.
std::string kill_section(const Record& record, std::size_t suite);

/// The ledger of nights, alarms first; empty if none is kept.
std::string ledger_section(const Ledger&);

/// One component of a map in colours with its scale below, a rectangle of it outlined if there is
/// one.
std::string map_picture(const Map&, std::size_t component, const ColourScale&,
                        const ImageFinding* found);

/// The cells of a sampler's domain: drawn, expected and the difference; empty where there are none.
std::string cells_section(const Test&);

/// The maps of an image in colours, the cell outlined where it differs most; empty where there is
/// no image.
std::string image_section(const Test&);

std::string suite_section(const Record&, std::size_t suite);
std::string test_section(const Test&, TestPlace);

}  // namespace assay::reports
