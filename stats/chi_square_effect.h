#pragma once

#include "stats/test_result.h"

namespace assay::stats {

// Internal. X2 of `observations` values in cells, whose noncentrality is observations w^2: for the
// fit of one sample (chi_square_fit.h) their number, of two (chi_square_two_sample.h)
// m n / (m + n).
struct ChiSquareStatistic {
  double value = 0;
  double degrees_of_freedom = 1;
  double observations = 1;

  // sqrt(max(0, X2 - nu) / observations), the estimate of w.
  double effect() const;
};

// X2 against the noncentral chi-square of ncp = observations null_effect^2: log_p_upper rejects
// "w <= null_effect", log_p_lower rejects "w >= null_effect". Asymptotic.
TestResult chi_square_effect(const ChiSquareStatistic& statistic, double null_effect);

// Central interval of w, low end at least 0.
Interval chi_square_effect_interval(const ChiSquareStatistic& statistic, double confidence);

}  // namespace assay::stats
