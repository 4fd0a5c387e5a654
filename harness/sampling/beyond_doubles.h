#pragma once

#include <string>

#include "stats/basics/joint_moments.h"

namespace assay::harness {

/// An error message if the powers of what `name` drew cannot be computed with, else "".
std::string beyond_doubles(const stats::JointMoments& powers, const std::string& name);

/// An error message if moments of `name` cannot be computed with, else "". The fourth power of the
/// spread may overflow, or underflow to nothing. The observations must not all be equal.
std::string beyond_doubles(const stats::Moments& moments, const std::string& name);

}  // namespace assay::harness
