#pragma once

#include <string>

namespace assay::harness {

std::string version();  ///< "0.1.0"
std::string commit();   ///< of the sources at configure time, abbreviated; "unknown" outside git

}  // namespace assay::harness
