#pragma once

// The subcommands, without the parsing of arguments. Those that answer an int return an exit code.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/base/identity.h"
#include "harness/base/work.h"
#include "harness/calibration/calibrate.h"
#include "harness/record/record_of.h"
#include "harness/suite/run_options.h"
#include "harness/suite/suite.h"
#include "reports/record/record.h"

namespace assay::harness {

/// The suites of these files with the parameters that `--set` assigns. InputError for any mistake.
std::vector<Suite> load_suites(const std::vector<std::string>& files,
                               const std::vector<std::string>& assignments = {});

/// Hears of a broken claim when it is decided.
using Broken = std::function<void(const reports::Test&)>;

/// Runs the selected tests of the suites. InputError for any mistake found before sampling. A
/// ledger that cannot be written is a std::runtime_error, or goes to `ledger_fault`.
reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    const Broken& broken = {}, std::string* ledger_fault = nullptr);

/// Runs the suites, writes the reports and keeps the run for `assay explain` and `assay replay`.
/// Returns 4 without a report if no test is selected.
int run_suites(const std::vector<Suite>& suites, const RunOptions& options, const Output& output);
/// Threads of each rank: as given, else one, since launchers start a rank for each core.
unsigned threads_of_rank(const RunOptions& options);
/// Tables of at most 80 columns without colours: a row a test, with notes on the forecast and the
/// pilot's gates below it. Totals end the page.
std::string plan_text(const PlannedRun& planned);
/// Returns 1 if a selected test cannot come out as expected: no method is valid, or a source
/// stopped. Returns 77 if all selected tests will be skipped, 4 if none is selected, else 0.
int plan_exit_code(const PlannedRun& planned);
int report_saved_run(const std::string& file, const Output& output);

struct ExplainArguments {
  std::vector<std::string> words = {};  ///< A saved run, or none for the last one, and a test.
};
/// Explains a test of a saved run. InputError if no test, or more than one, has the part in its id.
int explain(const ExplainArguments&);

/// A recorded test to draw again.
struct ReplayArguments {
  std::string record = "";                        ///< RUN.json; "": the last run from this folder
  std::string test;                               ///< id or name
  std::optional<std::uint64_t> observation = {};  ///< none: the whole test
};

/// Prints what was drawn. Returns 1 if something could not be, or differs.
int replay(ReplayArguments);

struct SampleArguments {
  std::string source;  ///< as in a claim: estimator or plugin, with part
  std::vector<std::string> estimators = {};
  std::optional<std::uint64_t> secondaries = {};  ///< Default: 10, or all rows.
  std::uint64_t primaries = 1;
  std::uint64_t seed = 1;
};
int sample(const SampleArguments&);

/// All that decides the numbers of a run: version, machine code, seed, options, and the files that
/// suites name. Of a file it takes the size and the first mebibyte.
Identity identity_of(const std::vector<Suite>& suites, const RunOptions& options);

/// A text that the program carries: a template of `assay init`, a script of `assay completion`, a
/// page of help, or what suites/README.md says of claims.
struct CarriedFile {
  std::string_view path;  ///< below harness/command, as "help/run.txt"; or "claims.md"
  std::string_view text;
};

/// In the order of their paths.
const std::vector<CarriedFile>& carried_files();
/// The text of the file of this path.
std::string_view carried_text(std::string_view path);

struct InitArguments {
  std::vector<std::string> words;  ///< KIND [FOLDER]; a kind has one word or two
};

/// Every kind as a user writes it: "process python".
std::vector<std::string> kinds_of_example();

/// Writes the example of that kind and prints what to do with it. InputError, and nothing written,
/// for an unknown kind, a word too many, and if one of its files is there already.
int write_example(const InitArguments& arguments);

// ---- What a command line asks for

struct SamplingCommand {
  RunOptions options;
  Output output;
};
struct SuitesCommand : SamplingCommand {
  std::vector<std::string> suites;
  std::vector<std::string> assignments;  ///< of --set
};
struct RunCommand : SuitesCommand {};
struct PlanCommand : SuitesCommand {
  bool list_renders = false;
};
/// Prints what a run would do; only pilots are drawn. Returns 4 if no test is selected, 1 if a test
/// cannot come out as expected. Or prints a line for each file that programs would render: command,
/// seed and file, with tabs between.
int plan_suites(const PlanCommand&);

struct CheckCommand : SamplingCommand {
  CheckArguments arguments;
};

struct ImagesCommand : SamplingCommand {
  ImagesArguments arguments;
};

struct CalibrateCommand {
  CalibrateArguments arguments;
  Output output;
};

struct ListCommand {
  std::string what;  ///< "plugins", "tests", a table of help.h; empty: all lists
  std::vector<std::string> suites;
  Selection selection;
};
/// Prints ids of tests, names of plugins, names and summaries of a table, or all lists. Returns 4
/// if no test is selected.
int print_list(const ListCommand&);

struct DescribeCommand {
  std::string name;  ///< of a plugin, or of a row of a table
};

struct ReportCommand {
  std::string file;
  Output output;
};

struct MergeCommand {
  std::vector<std::string> records;
  Output output;
};

/// The text for --help and --version.
struct TextCommand {
  std::string text;
};

using Command =
    std::variant<RunCommand, PlanCommand, CheckCommand, ImagesCommand, SampleArguments, ListCommand,
                 DescribeCommand, ReplayArguments, ReportCommand, MergeCommand, CalibrateCommand,
                 InitArguments, ExplainArguments, TextCommand>;

}  // namespace assay::harness
