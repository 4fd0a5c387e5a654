#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

/// A saved run. InputError when the file cannot be read, reports::ReadError when it is no record.
reports::Record read_record(const std::string& file);

}  // namespace assay::harness
