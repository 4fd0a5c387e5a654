#pragma once

// The reports that a command leaves, and its exit code.

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
  bool quiet = false;  ///< no progress
  bool github = true;  ///< a job of GitHub Actions is told what is not ok (github.h)
};

/// The text of a report, in colour or not.
using ReportWriter = std::function<std::string(const ReportRequest& request, bool colour)>;

/// InputError where a report's file cannot be written, or is one of `kept`, which the command reads
/// or keeps (files_read.h): better known before the hours of sampling than after.
void require_writable(const Output& output, const std::vector<std::string>& kept);
/// Every report asked for, the console's in any case. Files first: what standard output shows has
/// then been written. std::runtime_error at the end where some could not be; the others were.
void write_reports(const Output& output, const ReportWriter& written);
/// The same of a record. Maps are written beside the JSON report, which names them: the record then
/// has these names.
void write_reports(reports::Record& record, const Output& output);

/// Of a run: the reports, and what a job of GitHub Actions is told (github.h).
void report_run(reports::Record& record, const Output& output);

/// 0 every test ok; 1 at least one not, or an alarm of the ledger; 3 nothing failed but something
/// is inconclusive; 4 nothing ran; 77 all skipped.
int exit_code(const reports::Record&, InconclusivePolicy);

}  // namespace assay::harness
