#pragma once

// Every test of this folder includes this: tests/prelude.h, property tests, and records.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/words/display.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"
