#pragma once

#include <string>
#include <vector>

#include "harness/command/cli.h"

namespace assay::harness {

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
