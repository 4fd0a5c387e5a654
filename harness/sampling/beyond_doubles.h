#pragma once

#include <string>

#include "stats/basics/moments.h"

namespace assay::harness {

/// Why moments cannot be computed with: the fourth power of the spread is beyond doubles, or what
/// underflows leaves none. "" where they can. Of `name`'s observations, which are not all the same.
std::string beyond_doubles(const stats::Moments& moments, const std::string& name);

}  // namespace assay::harness
