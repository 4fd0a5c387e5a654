#pragma once

#include <string>

namespace assay {

/// The instruction set that rays are traced with ("avx2"); the bits of hits depend on it, so
/// records of runs name it.
std::string ray_instruction_set();

}  // namespace assay
