#pragma once

#include "stats/basics/moments.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

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
// The law is Student's t to second order even for normal data, hence `asymptotic`. One of the two
// samples may be constant; it then counts as known exactly. Throws std::domain_error (count < 2,
// non-finite arguments), ZeroVariance (vx + vy = 0). Their text names `caller`, as in student_t.h.
TestResult welch_t(const Moments& x, const Moments& y, Contrast null_value,
                   const char* caller = "welch_t");

// Central interval of E x - E y.
Interval welch_t_interval(const Moments& x, const Moments& y, double confidence);

// Central interval of E x / E y - 1 by inversion of the contrast E x - r E y = 0. (Fieller 1954,
// with Welch's degrees of freedom at each r.) If E y is not separated from zero at this confidence,
// the set of accepted ratios is unbounded. The interval is then (-infinity, infinity).
Interval welch_ratio_interval(const Moments& x, const Moments& y, double confidence);

}  // namespace assay::stats
