#pragma once

#include <cstdint>

#include "stats/basics/moments.h"
#include "stats/means/student_t.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

struct Successes {
  std::uint64_t successes = 0;
  std::uint64_t trials = 0;
};

// Null hypothesis: P(success) = null_probability. Exact binomial tails. They are discrete, so P(p
// <= a) <= a. Throws std::domain_error: no trials, successes > trials, probability outside [0, 1].
TestResult binomial(Successes observed, double null_probability);

// Null hypothesis: q is this probability, known up to `error` and perhaps outside [0, 1]. Each tail
// is that of the nearer end of the error.
TestResult binomial_within(Successes seen, double q, double error);

// Clopper & Pearson (1934): central interval of P(success), coverage at least `confidence`.
Interval clopper_pearson(Successes observed, double confidence);

// Evidence about theta = q + offset by these two, where q is the probability of a success. The
// offset may be off by `error`.
Evidence probability_evidence(const Successes& seen, double offset, double error = 0);

// ---- Two values

// Values that are either range.low or range.high, as a count of the high ones.
struct TwoValued {
  Range range;
  Successes high;
};

// The count in a sample that is declared two-valued, recovered from its moments. Throws
// std::domain_error if the smallest or largest value is neither of the two. It also throws if n
// (mean - low) / (high - low) is not within 1/4 of a whole number. That proves nothing about values
// in between.
TwoValued two_valued(const Moments& x, Range range);

// Null hypothesis: E x = null_mean, i.e. P(x = high) = (null_mean - low) / (high - low). The exact
// binomial test of that probability; statistic: the count of high values. A null mean
// outside the range is impossible: the tail that rejects it has the lowest logarithm. Throws
// std::domain_error: range empty or infinite, no values, non-finite null mean.
TestResult two_valued_mean(const TwoValued& x, double null_mean);

// Null hypothesis: E x - scale E y = offset (1 and d: a difference; r and 0: a ratio). A scale
// below 0 is one above it of -y. With 0 it is the exact test of E x.
//
// On the null's line of probabilities (p, q) the tails of the two counts are independent and exact.
// Fisher's product of them is taken at the least favourable point:
//   A = P(X <= hits of x | p),  B = P(Y >= hits of y | q).
//   W = max over the line of A B.
//   P-value of "E x - scale E y >= offset" = W (1 - ln W).
// (Fisher 1932, conservative for discrete counts; maximum over the nuisance probability: Barnard
// 1945.) ln A and ln B are concave in their probabilities, so there is one maximum. The mirrored
// tail is likewise. Exact and conservative (law "bound"), about 200 binomial tails of work. The
// statistic is mean x - scale mean y - offset. If no pair of probabilities meets the null, the tail
// that rejects it has the lowest logarithm. Throws std::domain_error: as above, non-finite scale or
// offset.
TestResult two_valued_contrast(const TwoValued& x, const TwoValued& y, Contrast null_value);
// Central interval of E x - E y by inversion. p falls with the distance from the estimate.
Interval two_valued_difference_interval(const TwoValued& x, const TwoValued& y, double confidence);

}  // namespace assay::stats
