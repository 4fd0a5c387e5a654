#pragma once

#include <cstdint>

#include "harness/question/question.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// True if a mutant's defect changed something: an observation of the pool differs from its
/// original's on the same stream. Declarations count too: another analytic mean or density. True
/// for an estimator that is no mutant.
bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations);

}  // namespace assay::harness
