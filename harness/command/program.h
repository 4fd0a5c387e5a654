#pragma once

// The program: its command line as data, what its environment asks of it, and what acts on both.

#include <string>
#include <vector>

#include "harness/base/terminal.h"
#include "harness/command/commands.h"

namespace assay::harness {

// ---- The command line. Parsing has no effects.

/// Parses the arguments after the program's name. InputError, if possible with a suggestion, for
/// anything that is not as `--help` says.
Command parse_command_line(const std::vector<std::string>& arguments);

/// A run that a command asks for.
struct Loaded {
  std::vector<Suite> suites;
  RunOptions options;
};

/// Reads the suites of `run`, `check` or `images`. InputError for any mistake in them, and for
/// other commands.
Loaded loaded(const Command& command);

// ---- The environment. A launcher, such as mpirun or srun, has tasks to join to one run. A test
// runner, such as GoogleTest or Bazel, has shards.

/// How many tasks of this command a launcher's environment tells of; 1 without one.
unsigned launched_tasks();

/// Replaces the process by `assay-mpi` beside `assay`, which joins tasks to one run, if it is one
/// of several tasks of a command that samples. Returns if it is not; InputError if that program is
/// missing.
void join_tasks(const std::vector<std::string>& arguments);

/// Does nothing if the options name a shard. It reads GTEST_TOTAL_SHARDS and GTEST_SHARD_INDEX
/// (from 0), else TEST_TOTAL_SHARDS and TEST_SHARD_INDEX; a total of 1 is a whole run. It makes the
/// files that GTEST_SHARD_STATUS_FILE and TEST_SHARD_STATUS_FILE name, which tell the runner that
/// shards work. InputError for one variable without the other, or an invalid shard.
void take_shard_from(const Environment& environment, RunOptions& options);

// ---- The program

/// The message for a mistake: place and sentence (in_lines), then the line with a caret. The text
/// `claim` is that of a claim from the command line.
std::string failure_text(const InputError& error, const std::string& claim);

class Messages;

/// The whole program, or rank 0 of several: parses, acts, and turns every exception into one clear
/// message on standard error. Returns the exit code (2 for mistakes and trouble, 130 when
/// interrupted).
int program(const std::vector<std::string>& arguments, Messages* ranks = nullptr);
/// Another rank: prepares the same run and draws for rank 0. Returns the exit code.
int program_of_rank(const std::vector<std::string>& arguments, Messages& ranks);

}  // namespace assay::harness
