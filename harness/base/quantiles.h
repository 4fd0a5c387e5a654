#pragma once

#include <span>
#include <vector>

#include "reports/record/record.h"

namespace assay::harness {

/// At most 99 points of a normal quantile plot of the values, at the probabilities (i - 1/2) / k.
std::vector<reports::QuantilePoint> quantile_points(std::span<const double> values);

}  // namespace assay::harness
