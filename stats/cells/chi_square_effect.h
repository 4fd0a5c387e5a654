#pragma once

#include <functional>

#include "stats/tails/tails.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Internal. X2 of two samples of m and n values in cells (chi_square_two_sample.h), whose
// noncentrality is `observations` w^2, m n / (m + n) of them.
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

// Central interval of w: effect_interval below.
Interval chi_square_effect_interval(const ChiSquareStatistic& statistic, double confidence);

// Central interval of an effect w >= 0, where `tails(w)` are those of the data if w were the
// effect: the upper rises with w and the lower falls. Low end at least 0; the high end, sought from
// `start` on, is infinite where no w is too large. Where the lower tail rejects even w = 0, as of
// data closer to the null law than chance leads to expect, no w is left: both ends are NaN.
Interval effect_interval(const std::function<LogTails(double)>& tails, double start,
                         double confidence);

}  // namespace assay::stats
