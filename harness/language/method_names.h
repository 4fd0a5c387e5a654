#pragma once

#include <string>
#include <vector>

namespace assay::harness {

/// The names of the method table, each once, in its order. The table defines it
/// (families/methods.cpp): a suite is read before any row is needed.
const std::vector<std::string>& method_names();

}  // namespace assay::harness
