#pragma once

// Data that tests take from the pilots: cells of two laws.

#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// True if the method needs the pilots.
bool takes_from_pilot(const Method& method);

/// Gives the plan's method what it takes from the pilots; sets `invalid` if they lack it. Rows of a
/// file are their own pilot, both sides together; beside drawn values they are not used.
void freeze(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
