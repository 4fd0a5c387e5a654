#pragma once

#include <cstdint>
#include <string>

#include "harness/question/question.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// Says what to do about pixels that are not finite.
constexpr const char* leave_out_nonfinite =
    ": mend the renderer, or leave such pixels out by `--ignore nonfinite` (in a suite by "
    "`finite`), which hides what is wrong there";

/// True of equal numbers, and of two that are none.
bool same_number(double one, double other);

/// Says which source of a test stopped, where and why; "" if none did.
std::string where_it_stopped(const TestWork& work);

/// Why a test's observations cannot be judged: not finite, or outside their declared range; "" if
/// they can.
std::string unusable(const DrawnTest& test);

/// The first draw that contradicts its sampler, in a clause; "" if none does.
std::string first_contradiction(const DrawnTest& test);

/// True if a mutant's defect changed something: an observation of the pool differs from its
/// original's on the same stream. Declarations count too: another analytic mean or density. True
/// for an estimator that is no mutant.
bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations);

}  // namespace assay::harness
