#pragma once

#include "harness/suite/suite.h"

namespace assay::harness {

/// The only test of `suite_of_claim`, without looking up its estimators.
TestEntry test_of_claim(const CheckArguments& arguments);

}  // namespace assay::harness
