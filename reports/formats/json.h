#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as JSON (record.schema.json): keys in fixed order, doubles that read back as the same
/// double. A number that does not exist is null; one that is not finite is the string "NaN",
/// "Infinity" or "-Infinity", never null. Text is clean (reports/text.h).
std::string json(const Record&);

/// The same without white space, for programs alone.
std::string compact_json(const Record&);

}  // namespace assay::reports
