#pragma once

#include <functional>

namespace assay::stats {

// Internal: the end of an interval on one side of `centre`, by doubling `first_step` (negative: to
// the left) and bracketing. `excess` is negative inside the interval, zero at its end. Infinite,
// with the sign of the step, where no end is found within 1e300.
double interval_end(const std::function<double(double)>& excess, double centre, double first_step);

}  // namespace assay::stats
