#pragma once

#include <string>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// Says which source of a test stopped, where and why; "" if none did.
std::string where_it_stopped(const TestWork& work);

/// Why a test's observations cannot be judged: not finite, or outside their declared range; "" if
/// they can.
std::string unusable(const DrawnTest& test);

/// The first draw that contradicts its sampler, as the end of a sentence; "" if none does.
std::string first_contradiction(const DrawnTest& test);

}  // namespace assay::harness
