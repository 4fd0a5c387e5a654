#pragma once

#include <cstdlib>
#include <functional>
#include <string>

namespace assay::harness {

/// The value of a variable; "" where it is not set.
using Environment = std::function<std::string(const std::string&)>;

inline std::string system_environment(const std::string& variable) {
  const char* value = std::getenv(variable.c_str());
  return value == nullptr ? "" : value;
}

}  // namespace assay::harness
