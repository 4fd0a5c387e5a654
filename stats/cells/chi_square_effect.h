#pragma once

#include <functional>

#include "stats/tails/tails.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Internal. X2 of two samples of m and n values in cells (chi_square_two_sample.h). Its
// noncentrality is observations w^2, observations = m n / (m + n).
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

// Central interval of an effect w >= 0. `tails(w)` are the data's tails if w were the effect. The
// upper one rises with w and the lower one falls. The low end is at least 0. The high end is sought
// from `start` on, and infinite if no w is too large. Both ends are NaN if the lower tail rejects
// even w = 0: such data are closer to the null law than chance allows.
Interval effect_interval(const std::function<LogTails(double)>& tails, double start,
                         double confidence);

}  // namespace assay::stats
