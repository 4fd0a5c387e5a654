#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// The reference of a mean. A standard error above zero enters the variance of the statistic.
struct Reference {
  double value = 0;
  double standard_error = 0;
};

// Values declared to lie in [low, high], low < high. An end may be infinite.
struct Range {
  double low = 0;
  double high = 1;
};

// Null hypothesis: E x = reference.value.
//   T = (mean - value) / sqrt(s2 / n + standard_error^2).
// Student's t with nu = n - 1. With a reference error nu = (s2/n + se^2)^2 / ((s2/n)^2 / (n-1)).
// That is Welch-Satterthwaite with infinitely many degrees of freedom for the reference (Welch
// 1947). Exact for normal data and an exact reference; asymptotic with a reference
// error. Throws std::domain_error (count < 2, non-finite value, negative error), ZeroVariance (s2 =
// 0). Their text names `caller`: the function that the user called.
TestResult student_t(const Moments& x, Reference null_mean, const char* caller = "student_t");

// Central interval of E x - reference.value. Throws as student_t, and for confidence outside (0,
// 1).
Interval student_t_interval(const Moments& x, Reference reference, double confidence);

// ---- Two means

// The null hypothesis E x - scale * E y = offset. A relative margin m of y is scale = 1 + m or 1 -
// m.
struct Contrast {
  double scale = 1;
  double offset = 0;
};

// mean x - scale mean y - offset, rounded once at the end (Moments::rest).
double contrast_of_means(const Moments& x, const Moments& y, Contrast contrast);

// Null hypothesis: E x - scale E y = offset, variances free (Welch 1947, Satterthwaite 1946).
//   T  = (mean x - scale mean y - offset) / sqrt(vx + vy),  vx = s2x / nx,  vy = scale^2 s2y / ny.
//   Degrees:  (vx + vy)^2 / (vx^2 / (nx - 1) + vy^2 / (ny - 1)).
// The law is Student's t to second order even for normal data, hence asymptotic. One of the two
// samples may be constant; it then counts as known exactly. Throws std::domain_error (count < 2,
// non-finite arguments), ZeroVariance (vx + vy = 0). Their text names `caller`.
TestResult welch_t(const Moments& x, const Moments& y, Contrast null_value,
                   const char* caller = "welch_t");

}  // namespace assay::stats
