#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

/// Reads a saved run. InputError if the file cannot be read, reports::ReadError if it is no record.
reports::Record read_record(const std::string& file);

}  // namespace assay::harness
