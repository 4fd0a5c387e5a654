#pragma once

// Records of arbitrary content for property tests: any bytes as text, any bits as numbers.

#include <rapidcheck.h>

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

rc::Gen<double> any_double();
rc::Gen<std::string> any_text();
Record random_record();

}  // namespace assay::reports
