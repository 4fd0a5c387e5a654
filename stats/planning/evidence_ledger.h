#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace assay::stats {

// Evidence about one number theta that several runs share, such as the bias of an estimator. A
// night brings a score and an information, and both add up. Only runs with fresh, independent
// streams are evidence. A replay is not.
struct Evidence {
  double score = 0;        // (estimate - null value) / standard_error^2.
  double information = 0;  // 1 / standard_error^2.

  Evidence& operator+=(const Evidence& other);
  friend bool operator==(const Evidence&, const Evidence&) = default;
};

// `difference` is estimate - null value. The reference's own error is not part of standard_error:
// it is the same on all nights and belongs to the prior below. A night that stopped early
// contributes the information it gathered. Throws std::domain_error unless the error is positive.
struct NightEstimate {
  double difference = 0;
  double standard_error = 1;
};
Evidence evidence_of(NightEstimate night);

// Fixed before the first night: never from the data.
struct LedgerPrior {
  double effect = 1;  // tau > 0: standard deviation of theta under the alternative
  double reference_error =
      0;  // u >= 0: standard error of the reference all nights are held against
};

// Null hypothesis: theta = 0. The score is then S ~ normal(0, A), A = V + V^2 u^2, for the
// information V of all nights. With theta ~ normal(0, tau^2) its variance is B = A + V^2 tau^2. The
// evidence E is
//   ln E = ln(A / B) / 2 + S^2 / 2 (1 / A - 1 / B).
// That is the log likelihood ratio of the whole series. Under the null hypothesis E is a martingale
// with mean 1, also over the error of the reference. So P(E ever >= 1 / alpha) <= alpha (Robbins
// 1970; Ville 1939). Asymptotic in the size of a night, because its standard error is estimated.
double log_e_value(const Evidence& total, const LedgerPrior& prior);

// The first night with E >= 1 / alpha.
std::optional<std::size_t> first_alarm(std::span<const double> log_e, double alpha);

// Likelihood of "theta was 0 before night k and normal(0, tau^2) from it on", against "0
// throughout". The error of the reference is integrated out of both.
struct ChangePoint {
  std::size_t night = 0;            // The most likely first changed night.
  double log_likelihood_ratio = 0;  // Its own, against no change.
  // Each night's share of the summed likelihood. It is a posterior under equal prior weights, given
  // that there was a change.
  std::vector<double> share;
};
ChangePoint change_point(std::span<const Evidence> nights, const LedgerPrior& prior);

// The most likely nights whose shares reach `credibility`, ascending.
std::vector<std::size_t> credible_nights(const ChangePoint& change, double credibility);

// An e-value from a p-value, for tests without a score such as distances between laws and images.
// It integrates p^(kappa - 1) kappa (Vovk & Wang 2021, eq. 2): E = (1 - p + p ln p) / (p (ln p)^2).
// For independent nights add the logarithms.
double log_e_from_log_p(double log_p);

}  // namespace assay::stats
