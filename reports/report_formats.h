#pragma once

// The reports that a record can be shown as, and their table.

#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "reports/record/calibration.h"
#include "reports/record/record.h"

namespace assay::reports {

struct ConsoleOptions {
  bool colour = false;        ///< ANSI escape sequences.
  int width = 80;             ///< Columns of a line at most; below 40 counts as 40.
  int detail = 0;             ///< 0: a line a suite. 1: a line a test. 2: all numbers.
  std::uint64_t slowest = 0;  ///< Names so many of the slowest tests.
  std::string report = "";    ///< Path of a report that shows more; "": none.
  std::string ending = "";    ///< A sentence after the verdict; "": none.
};

/// A broken claim in 5 lines at most, and an empty line. It may be told before the run ends.
std::string broken_claim(const Test&, const ConsoleOptions& = {});

/// The text of one run for a terminal or a log: suites, then claims that are not as they should be,
/// then the verdict. Claims whose ids are in `told` are left out of the second part.
std::string console(const Record&, const ConsoleOptions& = {},
                    const std::set<std::string>& told = {});

/// The record as JSON (record.schema.json): keys in fixed order, doubles that read back as the same
/// double. A number that does not exist is null; one that is not finite is the string "NaN",
/// "Infinity" or "-Infinity", never null. Text is clean (words/text.h).
std::string json(const Record&);

/// The same without white space, for programs alone.
std::string compact_json(const Record&);

/// A saved run that cannot be read. what() is "FILE: sentence".
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The record that json() wrote, now or with an earlier schema version. For any other text it
/// throws ReadError, which names the file and the place inside it.
Record read_json(std::string_view text, std::string_view file_name);

/// The record as JUnit XML, in the subset that GitLab, Jenkins, GitHub's actions and junitparser
/// share. A test is one case, with its own class name and name. A case that is not ok has exactly
/// one of three elements. It is <error> for the verdict error, <skipped> for inconclusive and
/// skipped, and <failure type="VERDICT"> for the rest. Numbers stand both as properties and as
/// text. The texts of a case stay below 64 KiB.
std::string junit(const Record&);

/// GitHub drops a whole step summary above 1024 KiB; other steps may have written to it before.
inline constexpr std::size_t markdown_limit = 900 * 1024;

/// The record as Markdown for a job summary ($GITHUB_STEP_SUMMARY) or a merge request's comment.
/// Tests that are not ok come first, with message and replay command; then each suite has a table.
/// The text has at most `limit` bytes and ends by saying what was cut.
std::string markdown(const Record&, std::size_t limit = markdown_limit);

/// GitHub shows ten annotations of a kind for each step and drops the rest without a word.
inline constexpr std::size_t most_annotations = 10;

/// GitHub's workflow commands, one a line: `::error file=…,line=…,title=…::message`. `::error`
/// names what is not ok, the worst first; `::warning` names what is undecided. Each kind has at
/// most ten, and the last counts the others. Returns "" if all is well. Escapes as the runner's
/// toolkit does: per cent, carriage return and line feed; in file and title colon and comma too.
std::string annotations(const Record&);

/// The record's numbers as OpenMetrics 1.0 text, for GitLab's `artifacts:reports:metrics` and
/// Prometheus. Numbers have six significant digits, so that unchanged ones are equal as text. There
/// are no times, and a number that does not exist has no line.
std::string metrics(const Record&);

/// The record as one page without network or fonts: the viewer's bundle and the packed record
/// (viewer/page.h), compressed and in base64. A reader without scripts sees the Markdown tables.
std::string html(const Record&);

/// Tells what happened to a test, in sentences for a reader without a course in statistics, and
/// what to do next, as lines to paste. An alarm of the test in the ledger is told too.
std::string explain(const Suite&, const Test&, int width, const Ledger& = {});

/// A new kind of report is a row and a file.
struct ReportFormat {
  std::string kind;    ///< as in `--report KIND=PATH`
  std::string ending;  ///< of a file that is meant to be one
  std::string summary;
  std::string (*of_record)(const Record&, const ConsoleOptions&);
  std::string (*of_calibration)(const Calibration&) = nullptr;  ///< null where there is none
};

const std::vector<ReportFormat>& report_formats();

/// std::out_of_range where there is none.
const ReportFormat& report_format(const std::string& kind);

}  // namespace assay::reports
