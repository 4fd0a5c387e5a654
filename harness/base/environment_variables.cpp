#include "harness/base/environment_variables.h"

#include <cstdlib>

namespace assay::harness {

std::string system_environment(const std::string& variable) {
  const char* value = std::getenv(variable.c_str());
  return value == nullptr ? "" : value;
}

}  // namespace assay::harness
