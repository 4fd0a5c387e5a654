#pragma once

// Writes a command's reports and chooses its exit code.

#include <functional>
#include <string>
#include <vector>

#include "reports/record/record.h"

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
  bool github = true;  ///< Tells GitHub Actions what is not ok (github.h).
};

/// Makes the text of a report, in colour or not.
using ReportWriter = std::function<std::string(const ReportRequest& request, bool colour)>;

/// InputError before sampling if a report's file cannot be written, or is one of `kept`
/// (files_read.h).
void require_writable(const Output& output, const std::vector<std::string>& kept);
/// Writes all requested reports and the console's, files first. std::runtime_error at the end if
/// some could not be written.
void write_reports(const Output& output, const ReportWriter& written);
/// The same for a record. Maps are written beside the JSON report, and the record gets their names.
void write_reports(reports::Record& record, const Output& output);

/// Writes the reports of a run, and tells GitHub Actions (github.h).
void report_run(reports::Record& record, const Output& output);

/// Returns 0 if every test is ok, and 1 if one is not or the ledger has an alarm. Returns 3 if
/// nothing failed but something is inconclusive, 4 if nothing ran, 77 if all were skipped.
int exit_code(const reports::Record&, InconclusivePolicy);

}  // namespace assay::harness
