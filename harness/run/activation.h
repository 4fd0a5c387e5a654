#pragma once

#include <cstdint>

#include "harness/question/question.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// Whether a mutant's defect changed anything: an observation of the pool that differs from its
/// original's on the same stream, or, where only what is declared is broken, a different analytic
/// mean or density. True for an estimator that is no mutant.
bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations);

}  // namespace assay::harness
