#pragma once

#include <cstdint>
#include <optional>

namespace assay::stats {

// Planning. `alpha` is the level of the test (its share of the family), split over both sides when
// two_sided; `beta` the accepted probability of missing the effect. Sample sizes may be fractional
// where a formula allows it. Every sample_size answers nothing when no number of samples suffices
// (or more than 2^53 were needed); every detectable answers infinity when no effect is found. All
// throw std::domain_error for alpha or beta outside (0, 1) and for inverted effects.
struct ErrorRates {
  double alpha = 0.01;
  double beta = 0.01;
  bool two_sided = true;
};

// Where "theta in C" ends and the effect to be found begins: 0 <= allow < detect.
struct EffectPlan {
  double allow = 0;
  double detect = 0;
};

// n = ((z_alpha + z_beta) sigma / (detect - allow))^2, sigma the standard deviation of one
// observation; z_alpha at alpha / 2 when two-sided. The planning formula of every near-normal
// method.
double normal_sample_size(double standard_deviation, EffectPlan effect, ErrorRates rates);

// ---- Mean against a reference: Student's t
// Null |theta| <= allow (two-sided) or
// theta <= allow. Noncentral t, exact for normal data; with reference_standard_error the degrees of
// freedom are Welch-Satterthwaite's at the planned variance.
struct MeanPlan {
  double standard_deviation = 1;
  double allow = 0;
  double reference_standard_error = 0;
  ErrorRates rates;
};
double student_t_power(const MeanPlan& plan, double n, double effect);
double student_t_detectable(const MeanPlan& plan, double n);
std::optional<std::uint64_t> student_t_sample_size(const MeanPlan& plan, double detect);

// ---- Two means: Welch's t, n_y = n_x * allocation
struct TwoMeansPlan {
  double standard_deviation_x = 1;
  double standard_deviation_y = 1;  // times the contrast's scale
  double allocation = 1;
  double allow = 0;
  ErrorRates rates;
};
double welch_power(const TwoMeansPlan& plan, double n_x, double effect);
double welch_detectable(const TwoMeansPlan& plan, double n_x);
std::optional<std::uint64_t> welch_sample_size(const TwoMeansPlan& plan, double detect);

// ---- Two one-sided tests of a mean
// P(pass) when theta = effect:
// exact, integral over the chi law of s of the normal probability of the acceptance region (Owen
// 1965; Phillips 1990). Margin symmetric about 0.
struct EquivalencePlan {
  double standard_deviation = 1;
  double margin = 0;
  double alpha = 0.01;  // of each one-sided test
  double beta = 0.01;
};
double equivalence_power(const EquivalencePlan& plan, double n, double effect);
std::optional<std::uint64_t> equivalence_sample_size(const EquivalencePlan& plan, double effect);

// ---- Variances
// Effects are
// ratios (variance over the null variance, or variance x over variance y). The null is ratio <=
// allow, or ratio in [1/allow, allow] when two-sided; allow >= 1. Mirror a claim about small ratios
// by exchanging the samples (F) or by `below` (chi-square): then effects are ratios < 1 and the
// null is ratio >= 1/allow.
struct VariancePlan {
  double allow = 1;
  bool below = false;
  ErrorRates rates;
};
double chi_square_variance_power(const VariancePlan& plan, double n, double ratio);
double chi_square_variance_detectable(const VariancePlan& plan, double n);
std::optional<std::uint64_t> chi_square_variance_sample_size(const VariancePlan& plan,
                                                             double detect);
struct SampleSizes {
  double x = 2;
  double y = 2;
};

double f_ratio_power(const VariancePlan& plan, SampleSizes sizes, double ratio);
double f_ratio_detectable(const VariancePlan& plan, SampleSizes sizes);
// Of each of two samples of one size.
std::optional<std::uint64_t> f_ratio_sample_size(const VariancePlan& plan, double detect);

// Normal approximation with SE^2 = (kurtosis_x - 1) / n_x [+ (kurtosis_y - 1) / n_y]; kurtosis_y =
// 1 gives the one-sample test. n is n_x, and n_y = n_x * allocation.
struct LogVariancePlan {
  double kurtosis_x = 3;
  double kurtosis_y = 1;
  double allocation = 1;
  double allow = 1;  // ratio
  ErrorRates rates;
};
double log_variance_power(const LogVariancePlan& plan, double n, double ratio);
double log_variance_detectable(const LogVariancePlan& plan, double n);
std::optional<std::uint64_t> log_variance_sample_size(const LogVariancePlan& plan, double detect);

// ---- Distances between laws: Kolmogorov-Smirnov
// Lower bound of the power: P(D < d_alpha) <=
// exp(-2 n (distance - allow - d_alpha)^2) (Hoeffding at the point of largest difference), d_alpha
// from the exact law; the sample size of one sample takes Massart's bound of d_alpha, a few in a
// thousand above it. With two samples n is the size of the first, n * allocation that of the
// second, and m n / (m + n) takes the place of n. Always one-tailed: rates.two_sided is ignored.
struct DistancePlan {
  bool two_samples = false;
  double allocation = 1;
  double allow = 0;
  ErrorRates rates;
};
double ks_power_bound(const DistancePlan& plan, double n, double distance);
double ks_detectable(const DistancePlan& plan, double n);
std::optional<std::uint64_t> ks_sample_size(const DistancePlan& plan, double detect);

// ---- Chi-square fit: noncentral chi-square, ncp = n w^2
struct FitPlan {
  double degrees_of_freedom = 1;
  double allow = 0;  // effect size w
  ErrorRates rates;  // always one-tailed
};
double chi_square_fit_power(const FitPlan& plan, double n, double effect);
double chi_square_fit_detectable(const FitPlan& plan, double n);
std::optional<std::uint64_t> chi_square_fit_sample_size(const FitPlan& plan, double detect);

}  // namespace assay::stats
