#pragma once

#include <string>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// Which source of a test stopped, where, and why; empty where none did.
std::string where_it_stopped(const TestWork& work);

/// Why a test's observations cannot be judged: some are not finite, or outside of the range that
/// their source declares; empty where they can.
std::string unusable(const DrawnTest& test);

/// Which draw was the first to contradict its sampler, as the end of a sentence; empty where none
/// did.
std::string first_contradiction(const DrawnTest& test);

}  // namespace assay::harness
