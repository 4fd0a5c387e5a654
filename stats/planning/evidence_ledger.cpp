#include "stats/planning/evidence_ledger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

void check_prior(const LedgerPrior& prior) {
  check::positive({"evidence_ledger", "effect"}, prior.effect);
  check::non_negative({"evidence_ledger", "reference_error"}, prior.reference_error);
}

void check_evidence(const Evidence& evidence) {
  check::finite({"evidence_ledger", "score"}, evidence.score);
  check::non_negative({"evidence_ledger", "information"}, evidence.information);
}

// ln of normal(r; 0, wide) / normal(r; 0, narrow), wide = narrow + added.
struct Widening {
  double narrow;
  double added;
};
double log_ratio(double r, Widening variance) {
  const double wide = variance.narrow + variance.added;
  const double curvature = variance.added / variance.narrow / wide;
  return -std::log1p(variance.added / variance.narrow) / 2 + r * r / 2 * curvature;
}

double square(double x) { return x * x; }

// The score's variance for a given information, and the part that the effect adds to it.
Widening score_variance(double information, const LedgerPrior& prior) {
  const double v = information;
  return {v + square(v * prior.reference_error), square(v * prior.effect)};
}

// ln likelihood ratio of a change between two series. Given the estimate before, that after is
// normal about the value that the common error of the reference predicts.
double log_change(const Evidence& before, const Evidence& after, const LedgerPrior& prior) {
  const double u2 = square(prior.reference_error);
  double expected = 0;
  double variance = 1 / after.information + u2;
  if (before.information > 0) {
    const double slope = u2 / (1 / before.information + u2);
    expected = slope * before.score / before.information;
    variance -= slope * u2;
  }
  return log_ratio(after.score / after.information - expected, {variance, square(prior.effect)});
}

Evidence sum_of(std::span<const Evidence> nights) {
  Evidence total;
  for (const Evidence& night : nights) {
    check_evidence(night);
    total += night;
  }
  return total;
}

}  // namespace

Evidence& Evidence::operator+=(const Evidence& other) {
  score += other.score;
  information += other.information;
  return *this;
}

Evidence evidence_of(NightEstimate night) {
  check::finite({"evidence_of", "difference"}, night.difference);
  check::positive({"evidence_of", "standard_error"}, night.standard_error);
  const double information = 1 / square(night.standard_error);
  return {night.difference * information, information};
}

double log_e_value(const Evidence& total, const LedgerPrior& prior) {
  check_prior(prior);
  check_evidence(total);
  if (total.information == 0) return 0;
  return log_ratio(total.score, score_variance(total.information, prior));
}

std::optional<std::size_t> first_alarm(std::span<const double> log_e, double alpha) {
  check::inside_unit({"first_alarm", "alpha"}, alpha);
  const auto found = std::find_if(log_e.begin(), log_e.end(),
                                  [&](double value) { return value >= -std::log(alpha); });
  if (found == log_e.end()) return std::nullopt;
  return static_cast<std::size_t>(found - log_e.begin());
}

ChangePoint change_point(std::span<const Evidence> nights, const LedgerPrior& prior) {
  check::at_least({"change_point", "nights"}, nights.size(), 1);
  check_prior(prior);
  for (const Evidence& night : nights) {
    check::positive({"change_point", "information"}, night.information);
  }
  std::vector<double> logs(nights.size());
  for (std::size_t k = 0; k < nights.size(); ++k) {
    logs[k] = log_change(sum_of(nights.first(k)), sum_of(nights.subspan(k)), prior);
  }
  ChangePoint change;
  const auto best = std::max_element(logs.begin(), logs.end());
  change.night = static_cast<std::size_t>(best - logs.begin());
  change.log_likelihood_ratio = *best;
  const double total = special::log_sum_of(logs);
  for (const double value : logs) change.share.push_back(std::exp(value - total));
  return change;
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

double log_e_from_log_p(double log_p) {
  check::log_probability({"log_e_from_log_p", "log_p"}, log_p);
  // With x = -ln p the e-value is (e^x - 1 - x) / x^2.
  const double x = -log_p;
  if (x > 1) return x - 2 * std::log(x) + std::log1p(-(1 + x) * std::exp(-x));
  double term = 0.5;
  double sum = 0;
  for (int k = 3; term > 1e-18; ++k) {
    sum += term;
    term *= x / k;
  }
  return std::log(sum);
}

}  // namespace assay::stats
