#pragma once

// Most tests of this folder include this: tests/prelude.h, suites that are run, and refusals.

#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"
