#pragma once

#include <functional>

namespace assay::stats {

// Internal: the end of an interval on one side of `centre`. It doubles `first_step` (negative: to
// the left), then brackets. `excess` is negative inside the interval and zero at its end. Infinite,
// with the sign of the step, if no end is found within 1e300.
double interval_end(const std::function<double(double)>& excess, double centre, double first_step);

}  // namespace assay::stats
