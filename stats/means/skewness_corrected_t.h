#pragma once

#include "stats/basics/moments.h"
#include "stats/gates/assumption_gates.h"
#include "stats/means/student_t.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Student's and Welch's t, held back by the first-order effect of skewness. T and nu are those of
// student_t.h, and a is the skewness of the mean over 6. The influence values psi are
// (x_i - mean x) / nx and -scale (y_i - mean y) / ny. A reference's error adds to the variance
// only.
//  `a   = sum psi^3 / (6 (sum psi^2 + standard_error^2)^1.5).
//   T_H = ((1 + 2 a T)^3 - 1) / (6 a) + a = T + a (2 T^2 + 1) + (4/3) a^2 T^3`.
// (Hall 1992, "On the removal of skewness by transformation", J. R. Statist. Soc. B 54.) For one
// sample a = g1 / (6 sqrt n). T_H is referred to Student's t with nu degrees of freedom, not to
// Hall's normal law. That exceeds the level .001 by a factor 1.9 for 50 normal values.
//
// Each tail is the larger of T's and T_H's. A skewed law has one tail of T too heavy, which T_H
// mends. A symmetric law of heavy tails is skewed by chance, which T_H follows and T does not
// (measurements.md). The statistic is what lies nearest to 0 from T to T_H. Both rise with T, so an
// interval is the exact inversion. Asymptotic: use it where residual_skewness_gate is green. All
// throw as the tests they correct.

// T_H, without a division by a.
double without_skewness(double t, double a);

// Null hypothesis: E x = null_mean.value.
TestResult skewness_corrected_t(const Moments& x, Reference null_mean,
                                const char* caller = "skewness_corrected_t");

// Null hypothesis: E x - scale E y = offset.
TestResult skewness_corrected_welch(const Moments& x, const Moments& y, Contrast null_value,
                                    const char* caller = "skewness_corrected_welch");

// ---- Validity of the correction

// The value is the factor by which the worse tail may exceed its nominal level at critical value x
// (measurements.md). Limit 2, green up to 1.25. It is the smaller of two factors, as both T and T_H
// have to reject: that of T (skewness_gate) and that of T_H,
//  `exp(max(0, x^4 (k/4 - 44 a^2 / 3)) + |a| x^3 (1 + x^2 / 24) (16.5 e + 121.5 a^2) + x^6 f / 3)`.
// Each sample has a share p_j of the variance and excess kurtosis kappa_j. Then k = sum p_j^2
// kappa_j / n_j, e = sum p_j^2 / n_j, f = sum p_j^3 / n_j^2.
//
// The first term is the next order of the self-normalised large deviation of T_H. Its rate is y^2 /
// 2 - y^4 ((kappa + 1) / 4 - 11 gamma^2 / 27); Student's law has the 1 / 4 already. The second is
// the bias of g1 for a gamma law, with its growth in x as measured on the exponential law. The
// third is the noise of g1 for normal data.
//
// `low` subtracts from the kurtosis what normal data show by themselves (kurtosis_gate). The last
// term stays, because too few values is no matter of chance.
Gate residual_skewness_gate(const Moments& x, Reference null_mean, double critical_value);
Gate residual_skewness_gate(const Moments& x, const Moments& y, double scale,
                            double critical_value);

}  // namespace assay::stats
