#pragma once

#include <array>
#include <string>
#include <string_view>

#include "reports/record/record.h"

namespace assay::reports {

/// The keys of a test that repeat its worst channel's, for readers that want one number a test.
inline constexpr std::array<std::string_view, 9> keys_of_worst_channel = {
    "statistic", "distribution",     "p_value",      "log10_p", "p_adjusted",
    "p_pass",    "log10_p_adjusted", "log10_p_pass", "effect"};

/// The record as JSON (record.schema.json): keys in fixed order, doubles that read back as the same
/// double. A number that does not exist is null; one that is not finite is the string "NaN",
/// "Infinity" or "-Infinity", never null. Text is clean (reports/text.h).
std::string json(const Record&);

/// The same without white space, for programs alone.
std::string compact_json(const Record&);

}  // namespace assay::reports
