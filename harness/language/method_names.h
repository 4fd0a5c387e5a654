#pragma once

#include <string>
#include <vector>

namespace assay::harness {

/// The names of the method table (families/methods.cpp), each once, in its order.
const std::vector<std::string>& method_names();

}  // namespace assay::harness
