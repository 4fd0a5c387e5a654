#pragma once

// Evidence about a sampler's own bookkeeping: what its density integrates to, and how often a draw
// contradicts what the sampler declares.

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "harness/theta/method.h"

namespace assay::harness {

/// theta = S + q - claimed: S the integral of the density over the domain plus its point masses, by
/// quadrature, known up to an error; q the probability of a draw that yields no point, by exact
/// binomial tests at the ends of what the error leaves.
Evidence evidence_of_integral(const Question& question, const ChannelData& data);

/// theta = q - claimed: q the probability of a draw that is inconsistent (consistency_setup.h), by
/// exact binomial tests: against "q = 0" one such draw is a proof.
Evidence evidence_of_inconsistency(const Question& question, const ChannelData& data);

}  // namespace assay::harness
