#pragma once

// What the subcommands do, apart from parsing their arguments. Each returns an exit code.

#include <functional>
#include <string>
#include <vector>

#include "harness/run.h"

namespace assay::harness {

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

/// Runs, writes the reports. 4 without a report when no test is selected.
int run_suites(const std::vector<Suite>& suites, const RunOptions& options, const Output& output);
/// Prints what a run of the suites would do; only pilots are drawn. 4 when no test is
/// selected, 1 when a test cannot come out as expected by its plan.
int plan_suites(const std::vector<Suite>& suites, const RunOptions& options, bool quiet);
int report_saved_run(const std::string& file, const Output& output);

struct ReplayArguments {
  std::string record;                             ///< RUN.json
  std::string test;                               ///< id or name
  std::optional<std::uint64_t> observation = {};  ///< one of them, else the whole test
};
int replay(const ReplayArguments&);

struct SampleArguments {
  std::string source;  ///< as in a claim: estimator or plugin, with part
  std::vector<std::string> estimators = {};
  std::optional<std::uint64_t> secondaries = {};  ///< default 10, or the rows there are
  std::uint64_t primaries = 1;
  std::uint64_t seed = 1;
};
int sample(const SampleArguments&);

int list_plugins();
/// One id a line. 4 when no test is selected.
int list_tests(const std::vector<Suite>& suites, const Selection& selection);
int describe(const std::string& plugin);

}  // namespace assay::harness
