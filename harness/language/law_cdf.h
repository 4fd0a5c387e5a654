#pragma once

#include <functional>

#include "harness/language/claim.h"

namespace assay::harness {

/// P(X <= x) of a law that a claim names, by Boost.Math; 0 and 1 outside its support. The law is
/// one of laws(), its numbers already checked (check_law).
std::function<double(double)> law_cdf(const Law& law);

}  // namespace assay::harness
