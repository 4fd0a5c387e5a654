#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record's numbers as OpenMetrics text (1.0), which GitLab's `artifacts:reports:metrics` reads
/// and Prometheus too: gauges of each test (`assay_ok`, 1 or 0, `assay_effect` with
/// `assay_effect_lower` and `_upper`, `assay_detectable`) and of each estimator's channel
/// (`assay_mean`, `assay_variance`). Six significant digits, so that what has not changed is
/// compared equal as text; no times. A number that does not exist has no line.
std::string metrics(const Record&);

}  // namespace assay::reports
