#pragma once

#include <span>

#include "stats/tails/tails.h"

namespace assay::stats::special {

// Internal: the pieces that the log tails are built of.

// Most negative finite double. It stands for the logarithm of a probability of zero.
double lowest_log();
// Clamps a logarithm to [lowest_log(), 0].
double clamp_log(double log_probability);
// Both tails from the smaller one.
LogTails from_lower(double log_lower);
LogTails from_upper(double log_upper);

// ln Gamma(z) - ((z - 1/2) ln z - z + ln(2 pi) / 2), Stirling's error.
double stirling_error(double z);
// ln sum exp of one or more finite logarithms.
double log_sum_of(std::span<const double> logs);

// ln(1 + z) - z without cancellation.
double log1p_minus(double z);
// a (ln r - r + 1): minus the deviance of a ratio r at weight a.
double log_deviance(double weight, double ratio);

// ln(f x^a e^-x / Gamma(a)) with a factor f > 0, and ln(x^a y^b / B(a, b)) with y = 1 - x. In
// deviance form the absolute error is a few ulps of the result and not of a ln a (Loader 2000).
double log_gamma_prefix(double shape, double x, double factor = 1);
struct BetaPoint {
  double x = 0;
  double y = 0;  // 1 - x, given apart so that neither loses digits.
};
double log_beta_prefix(BetaShape shape, BetaPoint point);
LogTails beta_tails_at(BetaPoint point, BetaShape shape);

}  // namespace assay::stats::special
