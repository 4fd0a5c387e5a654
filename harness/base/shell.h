#pragma once

#include <string>

namespace assay::harness {

/// An argument as a shell reads it back: quoted where that is needed.
std::string shell_quoted(const std::string& argument);

}  // namespace assay::harness
