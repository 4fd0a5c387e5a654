#pragma once

// Every test of this folder includes this: tests/prelude.h, samples and their laws, reference
// tables, calibrations.

#include "tests/philox.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/laws.h"
#include "tests/stats/samples.h"
#include "tests/stats/table.h"
