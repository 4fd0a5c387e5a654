#pragma once

#include <functional>
#include <string>

namespace assay::harness {

/// The value of a variable; "" where it is not set.
using Environment = std::function<std::string(const std::string&)>;

std::string system_environment(const std::string& variable);

}  // namespace assay::harness
