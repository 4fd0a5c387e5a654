#pragma once

#include <string>

namespace assay::harness {

/// What `assay --help` prints.
std::string general_help();

/// What stands before the options in `assay SUBCOMMAND --help`: a sentence and examples.
std::string help_of(const std::string& subcommand);

}  // namespace assay::harness
