#pragma once

#include <string>
#include <vector>

#include "harness/command/cli.h"

namespace assay::harness {

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
