#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record's numbers as OpenMetrics 1.0 text, for GitLab's `artifacts:reports:metrics` and
/// Prometheus. A test has the gauges `assay_ok` (1 or 0), `assay_effect`, `assay_effect_lower`,
/// `assay_effect_upper` and `assay_detectable`. An estimator's channel has `assay_mean` and
/// `assay_variance`. Numbers have six significant digits, so that unchanged ones are equal as text.
/// There are no times, and a number that does not exist has no line.
std::string metrics(const Record&);

}  // namespace assay::reports
