#pragma once

#include <string>

namespace assay::harness {

/// The argument, quoted for a shell if that is needed.
std::string shell_quoted(const std::string& argument);

}  // namespace assay::harness
