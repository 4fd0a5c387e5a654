#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace assay::stats {

// Evidence about one claim from many nights. Only runs with fresh, independent streams are
// evidence. A replay is not.

// One night's estimate of theta, such as the bias of an estimator. The reference's own error is no
// part of the standard error: all nights share it.
struct NightEstimate {
  double difference = 0;      // Estimate - null value.
  double standard_error = 0;  // 0 for values without spread.
  double observations = 1;    // > 0. A night that stopped early has the fewer.
  // Observations of equal size that would vary as much: Kish's n / kurtosis of their influence.
  double effective = 1;  // >= 1.
  friend bool operator==(const NightEstimate&, const NightEstimate&) = default;
};

// Nights pooled by the observations they drew: d = sum n_i d_i / sum n_i, with variance sum n_i^2
// e_i^2 / (sum n_i)^2. Weights 1 / e_i^2 would go with the estimates. A skewed sample with a small
// mean has a small error too, so nights would drift.
class PooledNights {
 public:
  // Throws std::domain_error: a difference that is not finite, a negative error, observations that
  // are not positive, fewer than one effective.
  void add(const NightEstimate& night);

  double difference() const;
  double variance() const;
  // The nights so far, in units of the first.
  double time() const;
  // True if the variance rests on `fewest_effective` observations. Fewer do not show it: five rare
  // hits may look as if ten had never been possible.
  bool speaks() const;

 private:
  double observations_ = 0;
  double first_ = 0;     // Observations of the first night.
  double sum_ = 0;       // Of observations times difference.
  double variance_ = 0;  // Of that sum.
  double squares_ = 0;   // Of the observations' parts of the variance.
};
inline constexpr double fewest_effective = 50;

// The null hypothesis, and the standard error u >= 0 of the reference that all nights share.
struct NullTheta {
  double value = 0;
  double reference_error = 0;
};

// Null hypothesis: theta = value. The pooled difference d is then normal with variance A = V + u^2.
// If theta - value ~ normal(0, tau^2), it has B = A + tau^2. The evidence E is the likelihood
// ratio,
//  `ln E = ln(A / B) / 2 + (d - value)^2 / 2 (1 / A - 1 / B)`.
// Here `tau^2 = t V / 5` for the time t: theta is 0.45 standard errors of a first night. So t fixes
// E's mixture, and no pilot. Under the null hypothesis E is a martingale with mean 1, also over the
// error of the reference. So P(E ever >= 1 / alpha) <= alpha (Robbins 1970; Ville 1939). Until the
// nights speak, E = 1. Asymptotic in the observations, because errors are estimated.
double log_e_value(const PooledNights& nights, const NullTheta& null);

// P-values of tests without an estimate, such as distances between laws and images.
struct PooledPValues {
  std::size_t nights = 0;
  double minus_log_p = 0;  // The sum T of -ln p.

  void add(double log_p);
};

// Null hypothesis: the p-values of K independent nights are uniform, or larger. The evidence is the
// likelihood ratio against the density kappa p^(kappa - 1) of every night, with one kappa, uniform
// in (0, 1):
//   E = integral of kappa^K e^((1 - kappa) T) = e^T gamma(K + 1, T) / T^(K + 1).
// Each kappa's product is a martingale with mean 1 (Vovk & Wang 2021), so E is. Exact. Nights whose
// p-values are all 1 leave E = 1 / (K + 1): a quiet night costs no constant factor.
double log_e_value(const PooledPValues& p_values);

// The first night with E >= 1 / alpha.
std::optional<std::size_t> first_alarm(std::span<const double> log_e, double alpha);

// Likelihood of "the null hypothesis held before night k, and the alternative from it on", against
// "it held throughout".
struct ChangePoint {
  std::size_t night = 0;            // The most likely first changed night.
  double log_likelihood_ratio = 0;  // Its own, against no change.
  // Each night's share of the summed likelihood. It is a posterior under equal prior weights, given
  // that there was a change.
  std::vector<double> share;
};
// Theta was `value` before, and normal about it from night k on, with the tau of all nights. The
// error of the reference is integrated out. Throws std::domain_error: no night.
ChangePoint change_point(std::span<const NightEstimate> nights, const NullTheta& null);
// The p-values' density was uniform before night k, and log_e_value's mixture from it on.
ChangePoint change_point(std::span<const double> log_p);

// The most likely nights whose shares reach `credibility`, ascending.
std::vector<std::size_t> credible_nights(const ChangePoint& change, double credibility);

}  // namespace assay::stats
