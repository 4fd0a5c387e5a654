#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace assay::stats {

// Evidence about one number theta that several runs share, for example the difference of an
// estimator from its reference: what one night brings is a score and an information, both of which
// add up. Only runs with fresh, independent streams are evidence; a replay is not.
struct Evidence {
  double score = 0;        // (estimate - null value) / standard_error^2
  double information = 0;  // 1 / standard_error^2

  Evidence& operator+=(const Evidence& other);
  friend bool operator==(const Evidence&, const Evidence&) = default;
};

// `difference` is estimate - null value; the reference's own error is not part of standard_error:
// it is the same on all nights and belongs to the prior below. A night that stopped early
// contributes the information it gathered; a standardised z would not be normal then. Throws
// std::domain_error unless the error is positive.
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

// Null hypothesis: theta = 0, where the score is S ~ normal(0, A), A = V + V^2 u^2, for the
// information V of all nights. With theta ~ normal(0, tau^2) its variance is B = A + V^2 tau^2, and
//   ln E = ln(A / B) / 2 + S^2 / 2 (1 / A - 1 / B)
// is the logarithm of the likelihood ratio of the whole series, hence a martingale with mean 1
// under the null hypothesis, over the error of the reference too: P(E ever >= 1 / alpha) <= alpha
// (Robbins 1970; Ville 1939). Asymptotic in the size of a night (its standard error is estimated).
double log_e_value(const Evidence& total, const LedgerPrior& prior);

// ln E after each night.
std::vector<double> log_e_values(std::span<const Evidence> nights, const LedgerPrior& prior);

// The first night with E >= 1 / alpha.
std::optional<std::size_t> first_alarm(std::span<const double> log_e, double alpha);

// ln p valid at any time: minus the largest ln E so far, at most 0.
double log_p_anytime(std::span<const double> log_e);

// When theta moved. Shiryaev and Roberts' sum of the E of the nights j..now over every start j: a
// process whose alarms at 1 / alpha come on average no more often than every 1 / alpha nights while
// nothing is wrong (e-detector: Shin, Ramdas & Rinaldo 2024). It never needs a reset.
double log_e_detector(std::span<const Evidence> nights, const LedgerPrior& prior);

// "theta was 0 before night k and has been normal(0, tau^2) from it on": likelihood of each k
// against "0 throughout", with the error of the reference integrated out of both.
struct ChangePoint {
  std::size_t night = 0;            // the most likely first changed night
  double log_likelihood_ratio = 0;  // its own, against no change
  std::vector<double> share;        // of each night's likelihood in their sum: a posterior under
                                    // equal prior weights, given that there was a change
};
ChangePoint change_point(std::span<const Evidence> nights, const LedgerPrior& prior);

// The most likely nights whose shares reach `credibility`, ascending.
std::vector<std::size_t> credible_nights(const ChangePoint& change, double credibility);

// p to e for what has no score (distances between laws, images): integrals over p^(kappa - 1) kappa
// (Vovk & Wang 2021, eq. 2), E = (1 - p + p ln p) / (p (ln p)^2). Independent nights multiply: add
// the logarithms.
double log_e_from_log_p(double log_p);

// How many equal nights until a night's alarm has probability >= 1 - beta when theta = effect;
// counts that last night alone, so it is an upper bound. Nothing when the reference's error forbids
// it or a million nights do not suffice.
struct LedgerPlan {
  double information = 1;  // of one night
  double effect = 1;       // theta to be found
  LedgerPrior prior;
  double alpha = 3e-3;
  double beta = 0.1;
};
std::optional<std::uint64_t> nights_to_find(const LedgerPlan& plan);

}  // namespace assay::stats
