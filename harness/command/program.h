#pragma once

#include <string>
#include <vector>

namespace assay::harness {

/// The whole program: parses, acts, and turns every exception into one clear message on standard
/// error. Returns the exit code (2 for mistakes and trouble, 130 when interrupted).
int program(const std::vector<std::string>& arguments);

}  // namespace assay::harness
