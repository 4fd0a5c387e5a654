#pragma once

// Reads values of command-line options. All functions throw InputError that names the option.

#include <optional>
#include <string>
#include <utility>

#include "harness/command/commands.h"

namespace assay::harness {

std::uint64_t parse_count(const std::string& text, const char* option, std::uint64_t least);
double parse_rate(const std::string& text, const char* option);  ///< is_error_rate
double parse_positive(const std::string& text, const char* option);

/// A count, or `random`: 64 bits from the operating system.
std::uint64_t parse_seed(const std::string& text);

/// "I/N" with 1 <= I <= N.
std::pair<unsigned, unsigned> parse_shard(const std::string& text);

/// "KIND=PATH" with a known kind.
ReportRequest parse_report(const std::string& text);

bool parse_github(const std::string& text);  ///< auto or never
Colour parse_colour(const std::string& text);
InconclusivePolicy parse_inconclusive(const std::string& text);

}  // namespace assay::harness
