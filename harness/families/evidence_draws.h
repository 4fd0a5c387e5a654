#pragma once

// Evidence about a sampler's bookkeeping: the integral of its density, and how often a draw
// contradicts its declarations.

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "harness/theta/method.h"

namespace assay::harness {

/// theta = S + q - claimed. Here S is the density's integral over the domain plus its point masses,
/// by quadrature with a known error. The other part, q, is the probability of a draw without a
/// point, by exact binomial tests at both ends of that error.
Evidence evidence_of_integral(const Question& question, const ChannelData& data);

/// theta = q - claimed. q is the probability of an inconsistent draw (consistency_setup.h), by
/// exact binomial tests. One such draw disproves "q = 0".
Evidence evidence_of_inconsistency(const Question& question, const ChannelData& data);

}  // namespace assay::harness
