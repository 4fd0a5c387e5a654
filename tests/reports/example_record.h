#pragma once

// Records for approved files: every verdict, several channels, missing numbers, and text that every
// writer must escape. No random numbers, and no functions whose last digit depends on the machine,
// take part.

#include "reports/record/record.h"

namespace assay::reports {

/// Three suites, about twenty tests. Every member differs from its default somewhere.
Record example_record();

}  // namespace assay::reports
