#include "harness/ledger/ledger_reading.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace assay::harness {
namespace {

constexpr double zeta_3 = 1.2020569031595942;
constexpr double credibility = 0.9;

template <class Value>
std::vector<Value> values_of(const std::vector<LedgerNight>& nights) {
  std::vector<Value> values;
  for (const LedgerNight& night : nights) values.push_back(std::get<Value>(night.value));
  return values;
}

/// The null hypothesis at the nearest value that the claim allows.
stats::NullTheta nearest(const ThetaRange& claimed, const stats::PooledNights& pooled,
                         const LedgerSeries& series) {
  return {.value = std::clamp(pooled.difference(), claimed.low, claimed.high),
          .reference_error = *series.reference_error};
}

}  // namespace

std::vector<stats::NightEstimate> estimates_of(const std::vector<LedgerNight>& nights) {
  return values_of<stats::NightEstimate>(nights);
}

std::vector<double> log_p_values_of(const std::vector<LedgerNight>& nights) {
  std::vector<double> log_p;
  for (const NightPValue& night : values_of<NightPValue>(nights)) log_p.push_back(night.log_p);
  return log_p;
}

std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const ThetaRange& claimed) {
  std::vector<double> path;
  if (series.has_estimates()) {
    stats::PooledNights pooled;
    for (const stats::NightEstimate& night : estimates_of(nights)) {
      pooled.add(night);
      path.push_back(stats::log_e_value(pooled, nearest(claimed, pooled, series)));
    }
    return path;
  }
  stats::PooledPValues pooled;
  for (const double log_p : log_p_values_of(nights)) {
    pooled.add(log_p);
    path.push_back(stats::log_e_value(pooled));
  }
  return path;
}

Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
            const ThetaRange& claimed) {
  const auto change = [&] {
    if (!series.has_estimates()) return stats::change_point(log_p_values_of(nights));
    const std::vector<stats::NightEstimate> estimates = estimates_of(nights);
    stats::PooledNights pooled;
    for (const stats::NightEstimate& night : estimates) pooled.add(night);
    return stats::change_point(estimates, nearest(claimed, pooled, series));
  }();
  const std::vector<std::size_t> credible = stats::credible_nights(change, credibility);
  return {change.night, credible.front(), credible.back()};
}

double generation_share(int generation) { return 1 / (zeta_3 * std::pow(generation, 3)); }

}  // namespace assay::harness
