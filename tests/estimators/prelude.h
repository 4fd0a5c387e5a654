#pragma once

// Tests that draw from plugins include this: tests/prelude.h, draws, and tables.

#include "tests/estimators/draws.h"
#include "tests/estimators/table.h"
#include "tests/prelude.h"
