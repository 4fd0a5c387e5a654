#pragma once

// The command line as data. Parsing has no effects; program.h acts on its result.

#include <string>
#include <variant>
#include <vector>

#include "harness/calibration/calibrate.h"
#include "harness/command/commands.h"
#include "harness/command/init.h"
#include "harness/record/merge.h"
#include "harness/suite/suite.h"

namespace assay::harness {

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
  std::string what;  ///< "plugins", "tests", a table of describe.h; empty: all lists
  std::vector<std::string> suites;
  Selection selection;
};

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

/// Parses the arguments after the program's name. InputError, if possible with a suggestion, for
/// anything that is not as `--help` says.
Command parse_command_line(const std::vector<std::string>& arguments);

/// The suites of these files with the parameters that `--set` assigns. InputError for any mistake.
std::vector<Suite> load_suites(const std::vector<std::string>& files,
                               const std::vector<std::string>& assignments = {});

/// A run that a command asks for.
struct Loaded {
  std::vector<Suite> suites;
  RunOptions options;
};

/// Reads the suites of `run`, `check` or `images`. InputError for any mistake in them, and for
/// other commands.
Loaded loaded(const Command& command);

}  // namespace assay::harness
