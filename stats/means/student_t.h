#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// The reference of a mean. A standard error above zero enters the variance of the statistic.
struct Reference {
  double value = 0;
  double standard_error = 0;
};

// Null hypothesis: E x = reference.value.
//   T = (mean - value) / sqrt(s2 / n + standard_error^2).
// Student's t with nu = n - 1. With a reference error nu = (s2/n + se^2)^2 / ((s2/n)^2 / (n-1)).
// That is Welch-Satterthwaite with infinitely many degrees of freedom for the reference (Welch
// 1947). Exact for normal data and an exact reference; asymptotic (labelled) with a reference
// error. Throws std::domain_error (count < 2, non-finite value, negative error), ZeroVariance (s2 =
// 0). Their text names `caller`: the function that the user called.
TestResult student_t(const Moments& x, Reference null_mean, const char* caller = "student_t");

// Central interval of E x - reference.value. Throws as student_t, and for confidence outside (0,
// 1).
Interval student_t_interval(const Moments& x, Reference reference, double confidence);

}  // namespace assay::stats
