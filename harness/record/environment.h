#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

reports::Tool this_tool();
reports::Environment this_environment(unsigned threads);
/// The time now as "2000-01-01T00:00:00Z".
std::string utc_now();

}  // namespace assay::harness
