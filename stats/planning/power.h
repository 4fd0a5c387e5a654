#pragma once

#include <cstdint>
#include <optional>

#include "stats/basics/moments.h"

namespace assay::stats {

// Planning. The level of the test is `alpha`, its share of the family, split over both sides when
// two_sided. Its `beta` is the accepted probability of missing the effect. Sample sizes may be
// fractional where a formula allows it. Every sample_size answers nothing if no number up to 2^53
// suffices. Every detectable answers infinity if no effect is found. All throw std::domain_error
// for alpha or beta outside (0, 1) and for inverted effects.
struct ErrorRates {
  double alpha = 0.01;
  double beta = 0.01;
  bool two_sided = true;
};

// The null region ends at `allow`, and the effect to be found begins at `detect`: 0 <= allow <
// detect.
struct EffectPlan {
  double allow = 0;
  double detect = 0;
};

// n = ((z_alpha + z_beta) sigma / (detect - allow))^2, sigma the standard deviation of one
// observation. z_alpha is at alpha / 2 when two-sided. Every near-normal method plans by it.
double normal_sample_size(double standard_deviation, EffectPlan effect, ErrorRates rates);

// The variance for which a test is planned. The logarithm of a pilot's variance has the variance
// s^2 = (kurtosis - 1) / n. Errors near .01 go like size^-6.5. They have the planned mean over such
// pilots if the pilot's variance is multiplied by exp(6.5 s^2 / 2).
double planned_variance(const Moments& pilot);

// ---- A mean against a reference, or two means: Student's t and Welch's
// Null hypothesis: |theta| <= allow (two-sided) or theta <= allow, in the unit of the values.
// Noncentral t (Johnson & Welch 1940), exact for one sample of normal data. A second sample has
// n * allocation observations. With v the planned
// variances of the means and of the reference, the degrees of freedom are Welch-Satterthwaite's:
//   (sum v)^2 / (v_x^2 / (n_x - 1) + v_y^2 / (n_y - 1)).
// With a skewness the test is corrected for it (skewness_corrected_t.h). The noncentrality is then
// T_H - a at T = effect / standard error. The critical value c is that of T and T_H both: T_H at c
// where it is farther out. An effect away from the long tail needs more.
struct MeanPlan {
  double standard_deviation = 1;
  double other_standard_deviation = 0;  // The second sample's, times the contrast's scale.
  double allocation = 1;
  double skewness = 0;  // An observation's, with the sign that it has on the effect's side.
  double other_skewness = 0;
  double allow = 0;
  double reference_standard_error = 0;
  ErrorRates rates;
};
double student_t_power(const MeanPlan& plan, double n, double effect);
double student_t_detectable(const MeanPlan& plan, double n);
std::optional<std::uint64_t> student_t_sample_size(const MeanPlan& plan, double detect);

// How many observations each of two samples has.
struct SampleSizes {
  double x = 2;
  double y = 2;
};

// ---- Distances between laws: Kolmogorov-Smirnov.
// The power is a lower bound, by Hoeffding at the point of largest difference:
//   P(D < d_alpha) <= exp(-2 n (distance - allow - d_alpha)^2).
// The exact law gives d_alpha. The sample size of one sample takes Massart's bound for it instead,
// a few in a thousand above. With two samples n is the size of the first, and n * allocation that
// of the second. Then m n / (m + n) takes the place of n. Always one-tailed: rates.two_sided is
// ignored.
struct DistancePlan {
  bool two_samples = false;
  double allocation = 1;
  double allow = 0;
  ErrorRates rates;
};
double ks_power_bound(const DistancePlan& plan, double n, double distance);
double ks_detectable(const DistancePlan& plan, double n);
std::optional<std::uint64_t> ks_sample_size(const DistancePlan& plan, double detect);

// ---- Chi-square fit: noncentral chi-square, ncp = n w^2, w^2 = sum (p - p0)^2 / p0 (Cohen 1988)
struct FitPlan {
  double degrees_of_freedom = 1;
  double allow = 0;  // Effect size w.
  ErrorRates rates;  // Always one-tailed.
};
double chi_square_fit_power(const FitPlan& plan, double n, double effect);
double chi_square_fit_detectable(const FitPlan& plan, double n);
std::optional<std::uint64_t> chi_square_fit_sample_size(const FitPlan& plan, double detect);

}  // namespace assay::stats
