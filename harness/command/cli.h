#pragma once

// The command line as data. Parsing has no effects; program.h acts on its result.

#include <string>
#include <vector>

#include "harness/command/commands.h"

namespace assay::harness {

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
