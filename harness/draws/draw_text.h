#pragma once

#include <cstdint>
#include <string>

#include "estimators/sampler.h"
#include "estimators/stream.h"

namespace assay::harness {

/// The draw of observation `index` and what the sampler declares at its point, with all digits.
std::string draw_text(const Sampler& sampler, StreamKey key, std::uint64_t index);

}  // namespace assay::harness
