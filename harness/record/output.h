#pragma once

// Writes a command's reports, tells GitHub Actions, keeps the run for `assay explain`, and chooses
// the exit code.

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "harness/base/terminal.h"
#include "reports/record/record.h"
#include "reports/report_formats.h"

namespace assay::harness {

enum class InconclusivePolicy { report, fail, pass };

/// `--report KIND=PATH`; PATH "-" is standard output.
struct ReportRequest {
  std::string kind;
  std::string path;
};

enum class Colour { automatic, always, never };

struct Output {
  std::vector<ReportRequest> reports = {};
  Colour colour = Colour::automatic;
  InconclusivePolicy inconclusive = InconclusivePolicy::report;
  bool quiet = false;  ///< No progress.
  int detail = 0;      ///< Of the console: reports::ConsoleOptions.
  std::uint64_t slowest = 0;
  bool github = true;      ///< Tells GitHub Actions what is not ok (tell_github).
  bool tells_code = true;  ///< The console says what exit code undecided claims make.
};

/// Makes the text of a report. The options are those of a console at its place.
using ReportWriter = std::function<std::string(const ReportRequest& request,
                                               const reports::ConsoleOptions& options)>;

/// InputError before sampling if a report's file cannot be written, or is one of `kept`
/// (suite.h).
void require_writable(const Output& output, const std::vector<std::string>& kept);
/// Writes all requested reports and the console's, files first. std::runtime_error at the end if
/// some could not be written.
void write_reports(const Output& output, const ReportWriter& written);

/// Tells of a broken claim at once, beside the progress. False if a file has the console.
bool tell_broken(const reports::Test& test, const Output& output);

/// Writes a record's reports and tells GitHub Actions. Maps are written beside the JSON report, and
/// the record gets their names. The console says no more of the claims that were told.
void write_run(reports::Record& record, const Output& output,
               const std::set<std::string>& told = {});

/// Returns 0 if every test is ok, and 1 if one is not or the ledger has an alarm. Returns 3 if
/// nothing failed but something is inconclusive, 4 if nothing ran, 77 if all were skipped.
int exit_code(const reports::Record&, InconclusivePolicy);

/// Returns annotations of GitHub Actions to print; "" unless GITHUB_ACTIONS is `true`. It also
/// appends the record as Markdown to the file that GITHUB_STEP_SUMMARY names. GitHub drops a
/// summary above reports::markdown_limit, so the text is cut there, with a remark. A summary that
/// cannot be written becomes a warning among the annotations, not a failure.
std::string tell_github(const reports::Record& record, const Environment& environment);

/// The last run from the current folder: a file in $XDG_CACHE_HOME/assay, else in ~/.cache/assay.
/// InputError if there is none.
std::string last_run();

/// Writes the record without its maps, whole or not at all. Nobody needs it to go on: a failure is
/// said only if asked.
void keep_last_run(reports::Record record, bool says_failure);

}  // namespace assay::harness
