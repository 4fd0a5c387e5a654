#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "harness/base/terminal.h"
#include "harness/run/evaluate.h"
#include "harness/run/planned_run.h"
#include "harness/suite/run_options.h"
#include "reports/record/record.h"
#include "reports/report_formats.h"

namespace assay::harness {

// ---- Where a record goes: a command's reports, GitHub Actions, the run that `assay explain`
// keeps, and the exit code

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

// ---- From results to the record

reports::Tool this_tool();
reports::Environment this_environment(unsigned threads);
/// The time now as "2000-01-01T00:00:00Z".
std::string utc_now();

void add_note(reports::Record& record, const std::string& note);
void note_retries(reports::Record& record);

/// The note of a record without some tests of its suites.
inline constexpr const char* partial_note =
    "not every test of the suites ran: their p-values are not adjusted by Holm's method, which "
    "takes all";

reports::Test record_of_test(const TestWork& work, const std::string& file);

/// Adds the command that repeats a test, or why there is none. It is that of its suite alone if it
/// can be. Some runs have no command.
void add_replay(const TestEntry& entry, const SuiteRun& run, const SuiteRuns& runs,
                const RunOptions& options, reports::Test& test);

reports::Test record_of_untested(const Untested& untested, const SuiteRun& run);

/// A test in its suite's family, with the p-values that Holm's method takes.
struct FamilyMember {
  reports::Test test;
  reports::FamilyResult place;
};

/// A test's place and p-values. Channels without a p-value are counted.
reports::FamilyResult place_in_family(const TestOutcome& outcome, const Suite& suite);

/// Fills in Holm's adjusted p-values over a suite's family, run together or in shards. They decide
/// nothing: a verdict rests on its test's own share of alpha. Invalid and error count as p = 1, and
/// so does a channel without a p-value. std::domain_error if the weights sum to more than 1.
void adjust_p_values(std::vector<FamilyMember>& suite);

/// True if the test is decided and not as its suite expects.
bool is_broken(const TestWork& work);

reports::Record record_of(const SuiteRuns& runs, const RunOptions& options);

// ---- Joins the shards of one run to the record of the whole run.

/// Fills in `record.shard`, which `merge` needs, and the note. `places` are those of each suite's
/// tests in the record.
void add_shard(const SuiteRuns& runs, const RunOptions& options,
               std::vector<std::vector<reports::FamilyResult>> places, reports::Record& record);

struct ShardFile {
  std::string file;
  reports::Record record;
};

/// The record of the whole run, with Holm over each suite's family. It equals one run's record byte
/// for byte, except for suites marked `timed`, times and threads. Shards may come in any order. A
/// missing one's tests are skipped; `seconds` is the sum. InputError, with file names, unless all
/// are shards of one run, each given once.
reports::Record merge(std::vector<ShardFile> shards);

/// Reads, merges and reports. Returns the exit code of the whole run, 1 if a shard is missing.
int merge_shards(const std::vector<std::string>& records, const Output& output);

// ---- Maps: records image tests by one row for each source, the findings, and maps.

/// Fills in a source's row: moments over its elements' means, counts over all elements.
void add_elements(const Subject& side, const Summary& summary, reports::Sample& row);

/// Adds findings and maps; nothing if the images could not be tested.
void add_image(const DrawnTest& drawn, reports::Test& test);

/// An image's row in the suite's picture: means over its elements, and of the variances of the
/// `averaged` primaries. The mean has an interval if the pixels are independent.
reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary, double averaged,
                                        double confidence);

/// Writes every map as an EXR file in the folder `<stem>.maps` beside the JSON report, and names
/// the files in the record. Throws std::runtime_error if one cannot be written.
void write_maps(reports::Record& record, const std::string& json_path);

/// Adds observed and expected counts of each cell and (observed - expected) / sqrt(expected). A
/// sampler is compared with its density, summed over all lobes. Two samples are compared by
/// chi-square-two-sample: the expected count is the first one's part of both together. Its
/// difference is divided by its standard deviation, sqrt(expected m / (n + m)). Adds nothing for
/// other claims, one coordinate, unequal numbers of cells, and tests without numbers.
void add_cells(const DrawnTest& drawn, reports::Test& test);

/// Each side's empirical distribution function with its simultaneous band and the claimed law, at
/// 63 or fewer points equally spaced in rank. The band's error is the channel's share of alpha at
/// the look. Draws without a point are left out. Empty unless the claim compares values of one
/// coordinate.
std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
