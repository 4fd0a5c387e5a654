#pragma once

#include <functional>

#include "harness/language/claim.h"

namespace assay::harness {

/// The distribution function P(X <= x), by Boost.Math. The law must have passed check_law().
std::function<double(double)> law_cdf(const Law& law);

}  // namespace assay::harness
