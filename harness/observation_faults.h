#pragma once

#include <string>

#include "harness/evaluate.h"

namespace assay::harness {

/// Why a test's observations cannot be judged: its source stopped, some of them are not finite, or
/// there was no plan; empty where they can.
std::string undrawable(const TestWork& work);

/// Which draw was the first to contradict its sampler, as the end of a sentence; empty where none
/// did.
std::string first_contradiction(const TestWork& work);

}  // namespace assay::harness
