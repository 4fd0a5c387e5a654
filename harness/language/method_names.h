#pragma once

#include <string>
#include <vector>

namespace assay::harness {

/// The names of the method table (theta/methods.h), each once, in its order.
const std::vector<std::string>& method_names();

/// Whether the method of this name compares all channels of two estimators together.
bool joins_channels(const std::string& method);

}  // namespace assay::harness
