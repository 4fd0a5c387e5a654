#pragma once

// Records to look at and to compare with approved files: every verdict, several channels, missing
// numbers, and text that no writer may pass on as it is. Made without random numbers and without
// functions whose last digit depends on the machine.

#include "reports/record/record.h"

namespace assay::reports {

/// Three suites, about twenty tests. Every member differs from its default somewhere.
Record example_record();

/// One suite of forty estimators with all their pairs.
Record forty_estimators();

}  // namespace assay::reports
