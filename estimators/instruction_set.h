#pragma once

#include <string>

namespace assay {

/// The instruction set that rays are traced with: "avx2", "sse4.2" on older x86 processors, or
/// "sse2" on others, where Embree translates it. Hits at edges may differ in the last bit between
/// them, so a record of a run names it.
std::string ray_instruction_set();

}  // namespace assay
