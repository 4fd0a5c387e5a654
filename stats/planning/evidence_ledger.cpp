#include "stats/planning/evidence_ledger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

constexpr double prior_ratio = 0.2;  // (tau / a first night's standard error)^2
// Larger -ln p are taken for this one, so that sums stay finite. A larger p is valid.
constexpr double largest_minus_log_p = 1e9;

// ln of normal(r; 0, narrow + added) / normal(r; 0, narrow), of variances.
double log_ratio(double r, double narrow, double added) {
  if (!(narrow > 0)) return 0;
  const double relative = added / narrow;
  return -std::log1p(relative) / 2 + r * r / 2 * (relative / (narrow + added));
}

double square(double x) { return x * x; }

double prior_variance(const PooledNights& all) { return prior_ratio * all.time() * all.variance(); }

PooledNights pooled(std::span<const NightEstimate> nights) {
  PooledNights all;
  for (const NightEstimate& night : nights) all.add(night);
  return all;
}

// ln likelihood ratio of a change between two series. Given the difference before, that after is
// normal about the value that the common error of the reference predicts.
double log_change(const PooledNights& before, const PooledNights& after, const NullTheta& null,
                  double effect_variance) {
  const double u2 = square(null.reference_error);
  double expected = null.value;
  double variance = after.variance() + u2;
  if (before.time() > 0 && before.variance() + u2 > 0) {
    const double slope = u2 / (before.variance() + u2);
    expected += slope * (before.difference() - null.value);
    variance -= slope * u2;
  }
  return log_ratio(after.difference() - expected, variance, effect_variance);
}

ChangePoint change_point_of(const std::vector<double>& logs) {
  ChangePoint change;
  const auto best = std::max_element(logs.begin(), logs.end());
  change.night = static_cast<std::size_t>(best - logs.begin());
  change.log_likelihood_ratio = *best;
  const double total = special::log_sum_of(logs);
  for (const double value : logs) change.share.push_back(std::exp(value - total));
  return change;
}

// ln of the sum of t^j / ((k + 1) ... (k + 1 + j)) over j >= 0, for t <= k + 1.
double log_series(double k, double t) {
  double term = 1 / (k + 1);
  double sum = 0;
  for (double next = k + 2; term > 1e-17 * sum; ++next) {
    sum += term;
    term *= t / next;
  }
  return std::log(sum);
}

}  // namespace

void PooledNights::add(const NightEstimate& night) {
  check::finite({"PooledNights", "difference"}, night.difference);
  check::non_negative({"PooledNights", "standard_error"}, night.standard_error);
  check::positive({"PooledNights", "observations"}, night.observations);
  if (!(night.effective >= 1) || std::isinf(night.effective))
    check::fail({"PooledNights", "effective"}, night.effective, "at least 1 and finite");
  if (observations_ == 0) first_ = night.observations;
  observations_ += night.observations;
  sum_ += night.observations * night.difference;
  const double part = square(night.observations * night.standard_error);
  variance_ += part;
  squares_ += square(part) / night.effective;
}

double PooledNights::difference() const { return observations_ > 0 ? sum_ / observations_ : 0; }

double PooledNights::variance() const {
  return observations_ > 0 ? variance_ / square(observations_) : 0;
}

double PooledNights::time() const { return first_ > 0 ? observations_ / first_ : 0; }

bool PooledNights::speaks() const {
  return variance_ > 0 && square(variance_) >= fewest_effective * squares_;
}

double log_e_value(const PooledNights& nights, const NullTheta& null) {
  check::finite({"log_e_value", "value"}, null.value);
  check::non_negative({"log_e_value", "reference_error"}, null.reference_error);
  if (!nights.speaks()) return 0;
  return log_ratio(nights.difference() - null.value,
                   nights.variance() + square(null.reference_error), prior_variance(nights));
}

void PooledPValues::add(double log_p) {
  check::log_probability({"PooledPValues", "log_p"}, log_p);
  ++nights;
  minus_log_p += std::min(-log_p, largest_minus_log_p);
}

double log_e_value(const PooledPValues& p_values) {
  const double k = static_cast<double>(p_values.nights);
  const double t = p_values.minus_log_p;
  if (t <= k + 1) return log_series(k, t);
  return t + std::lgamma(k + 1) - (k + 1) * std::log(t) + gamma_tails(t, k + 1).lower;
}

std::optional<std::size_t> first_alarm(std::span<const double> log_e, double alpha) {
  check::inside_unit({"first_alarm", "alpha"}, alpha);
  const auto found = std::find_if(log_e.begin(), log_e.end(),
                                  [&](double value) { return value >= -std::log(alpha); });
  if (found == log_e.end()) return std::nullopt;
  return static_cast<std::size_t>(found - log_e.begin());
}

ChangePoint change_point(std::span<const NightEstimate> nights, const NullTheta& null) {
  check::at_least({"change_point", "nights"}, nights.size(), 1);
  const double effect_variance = prior_variance(pooled(nights));
  std::vector<double> logs(nights.size());
  for (std::size_t k = 0; k < nights.size(); ++k) {
    logs[k] = log_change(pooled(nights.first(k)), pooled(nights.subspan(k)), null, effect_variance);
  }
  return change_point_of(logs);
}

ChangePoint change_point(std::span<const double> log_p) {
  check::at_least({"change_point", "nights"}, log_p.size(), 1);
  std::vector<double> logs(log_p.size());
  PooledPValues since;
  for (std::size_t k = log_p.size(); k-- > 0;) {
    since.add(log_p[k]);
    logs[k] = log_e_value(since);
  }
  return change_point_of(logs);
}

std::vector<std::size_t> credible_nights(const ChangePoint& change, double credibility) {
  check::inside_unit({"credible_nights", "credibility"}, credibility);
  std::vector<std::size_t> order(change.share.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return change.share[a] > change.share[b]; });
  double reached = 0;
  std::size_t taken = 0;
  while (taken < order.size() && reached < credibility) reached += change.share[order[taken++]];
  order.resize(taken);
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace assay::stats
