#pragma once

#include <string>

namespace assay::harness {

/// The text of `assay --help`.
std::string general_help();

/// The text before the options in `assay SUBCOMMAND --help`: a sentence and examples.
std::string help_of(const std::string& subcommand);

/// CLI11's help with its options at most 100 columns wide.
std::string wrapped_options(const std::string& help);

}  // namespace assay::harness
